#include "engine/world/EventDispatch.h"

#include <typeinfo>

#include "engine/events/EventOut.h"
#include "engine/world/ClassName.h"
#include "engine/world/EventPlayer.h"
#include "engine/world/Interests.h"
#include "engine/world/ObjectExtras.h"
#include "engine/world/ObjectProfile.h"
#include "engine/world/ObjectRegistry.h"
#include "engine/world/WorldLog.h"
#include "engine/world/WorldState.h"

namespace df {

EventDispatch::EventDispatch(ObjectRegistry& objects, Interests& interests, const WorldState& state,
                             std::function<void()> shut_down)
    : m_store(objects.store()),
      m_objects(objects),
      m_interests(interests),
      m_log(objects.log()),
      m_state(state),
      m_shut_down(std::move(shut_down)) {}

int EventDispatch::onEvent(const Event* p_event) {
  if (p_event == nullptr) return 0;
  const EventType& type = p_event->getType();
  if (&type == &UNDEFINED_EVENT)
    m_log.writeOnce("WM.onEvent() of a " + classNameOf(typeid(*p_event)) +
                    " without a type: setType() was forgotten");
  // Joins and leaves are sent even during a pause, because the game needs them when it continues.
  return send(*p_event, m_state.paused && type != JOIN_EVENT && type != LEAVE_EVENT);
}

int EventDispatch::send(const Event& event, bool is_paused) {
  nameClassOf(event);
  int delivered = 0;
  m_interests.visit(event.getType(), [&](ObjectKey key) {
    const Object* p_object = is_paused ? m_store.find(key) : nullptr;
    if (is_paused && (p_object == nullptr || !p_object->receivesWhilePaused())) return;
    delivered += deliver(key, event) ? 1 : 0;
  });
  return delivered;
}

bool EventDispatch::deliver(ObjectKey key, const Event& event) {
  constexpr std::uint32_t kThere = WorldStore::kInWorld | WorldStore::kActive;
  if (!m_store.isCurrent(key) || (m_store.flags(key.slot) & kThere) != kThere) return false;
  if (m_store.handlesEvents(key.slot)) runHandler(key, *m_store.object(key.slot), event);
  return true;
}

void EventDispatch::quarantine(ObjectKey key, const std::string& why) {
  Object* p_o = m_store.find(key);
  m_log.write("An object" + (p_o != nullptr ? " of type " + nameOf(*p_o) : std::string()) +
              " threw an exception and is removed from the game: " + why);
  if (p_o == nullptr) return;
  p_o->setActive(false);
  m_objects.markForDelete(p_o);
}

void EventDispatch::classifyNewObjects() {
  for (const ObjectKey key : m_store.popNewObjects()) {
    if (m_store.isCurrent(key)) classifyObject(key.slot);
  }
}

void EventDispatch::classifyObject(std::uint32_t slot) {
  const Object& object = *m_store.object(slot);
  if (m_p_page != nullptr) addClassName(slot);
  m_store.set(slot, WorldStore::kClassified, true);
  m_store.set(slot, WorldStore::kNeverDraws, typeid(object) == typeid(Object));
  const bool deaf = object.hasNoEventHandler();
  m_store.set(slot, WorldStore::kNoEventHandler, deaf);
  if (deaf && !m_store.profile(slot).interests.empty() && typeid(object) != typeid(Object)) {
    m_log.writeOnce(nameOf(object) +
                    " registers interest in events but has no matching eventHandler(): it must be declared "
                    "\"int eventHandler(const df::Event*) override\"");
  }
}

void EventDispatch::setPage(ActivityPage* p_page) {
  m_p_page = p_page;
  m_p_activity = p_page != nullptr ? &p_page->now : &m_own_activity;
  m_named_event = 0;
  if (p_page == nullptr) return;
  const WorldStore::Walk walk(m_store);
  for (std::size_t i = 0; i < walk.size(); ++i) {
    if (walk[i] != WorldStore::kNoSlot && m_store.has(walk[i], WorldStore::kClassified))
      addClassName(walk[i]);
  }
  // The engine sends them without onEvent(), so their names are added here.
  addEventName(EventCollision());
  addEventName(EventOut());
}

void EventDispatch::addClassName(std::uint32_t slot) {
  const Object& object = *m_store.object(slot);
  m_p_page->addName(classOf(object), typeid(object).name());
}

void EventDispatch::addEventName(const Event& event) {
  m_named_event = classOf(event);
  m_p_page->addName(m_named_event, typeid(event).name());
}

}  // namespace df
