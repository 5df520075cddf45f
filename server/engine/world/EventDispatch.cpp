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

namespace {

/// Ticks without an event after which a handler without registered interests is reported.
constexpr int kUnheardTicks = 300;
constexpr int kDone = -1;  ///< Unheard::due of a class that got an event or was reported

}  // namespace

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

void EventDispatch::attend(ObjectKey key) {
  const Object* p_o = m_store.find(key);
  const auto heard = p_o != nullptr ? m_unheard.find(classOf(*p_o)) : m_unheard.end();
  if (heard != m_unheard.end()) heard->second.due = kDone;
  if (m_shutdown_pending) m_shut_down();
}

// An Object that only handles collisions and its leaving of the world needs no interest, so only one that got
// no event for some time is reported. Which types a handler tests is not known.
void EventDispatch::reportUnheard() {
  m_attends = m_shutdown_pending;
  for (auto& [object_class, unheard] : m_unheard) {
    if (unheard.due == kDone) continue;
    m_attends = m_attends || m_state.step_count < unheard.due;
    if (m_state.step_count < unheard.due) continue;
    unheard.due = kDone;
    const Object* p_o = m_store.find(unheard.key);
    if (p_o == nullptr || !p_o->isActive() || !m_store.profile(unheard.key.slot).interests.empty()) continue;
    m_log.writeOnce(nameOf(*p_o) + " has an eventHandler() that got no event in " +
                    std::to_string(kUnheardTicks) +
                    " ticks, and it registers interest in none: was registerInterest() forgotten?");
  }
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
  if (m_attends) reportUnheard();
}

void EventDispatch::classifyObject(std::uint32_t slot) {
  const Object& object = *m_store.object(slot);
  if (m_p_page != nullptr) addClassName(slot);
  m_store.set(slot, WorldStore::kClassified, true);
  m_store.set(slot, WorldStore::kNeverDraws, typeid(object) == typeid(Object));
  const bool deaf = object.hasNoEventHandler();
  m_store.set(slot, WorldStore::kNoEventHandler, deaf);
  if (!deaf && m_store.profile(slot).interests.empty()) {
    const Unheard first{m_store.key(slot), m_state.step_count + kUnheardTicks};
    m_attends = m_unheard.try_emplace(classOf(object), first).second || m_attends;
  }
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
