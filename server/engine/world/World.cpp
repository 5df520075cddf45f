#include "engine/world/World.h"

#include <typeinfo>
#include <utility>

#include "engine/events/EventOut.h"
#include "engine/events/EventStep.h"
#include "engine/world/ActivityPage.h"
#include "engine/world/Capture.h"
#include "engine/world/ClassName.h"
#include "engine/world/ControlApplier.h"
#include "engine/world/EventPlayer.h"
#include "engine/world/InputQueue.h"
#include "engine/world/InterestDispatch.h"
#include "engine/world/Interests.h"
#include "engine/world/Mover.h"
#include "engine/world/Object.h"
#include "engine/world/ObjectProfile.h"
#include "engine/world/Runner.h"
#include "engine/world/Started.h"
#include "engine/world/Views.h"
#include "engine/world/WorldExtras.h"
#include "engine/world/WorldStore.h"

namespace df {

namespace {

thread_local World* t_p_current = nullptr;

// Sets a flag while it lives.
class During {
 public:
  explicit During(bool& flag) : m_flag(flag) { m_flag = true; }
  ~During() { m_flag = false; }
  During(const During&) = delete;
  During& operator=(const During&) = delete;

 private:
  bool& m_flag;
};

}  // namespace

World::World()
    : m_p_store(new WorldStore(this)),
      m_interests(std::make_unique<Interests>(*this)),
      m_views(std::make_unique<Views>(*this)),
      m_capture(std::make_unique<Capture>(*this)),
      m_input(std::make_unique<InputQueue>(*this)),
      m_mover(std::make_unique<Mover>(*this)),
      m_own_activity(std::make_unique<Activity>()),
      m_p_activity(m_own_activity.get()) {}

World::~World() {
  {
    const WorldStore::Walk walk(*m_p_store);
    for (std::size_t i = 0; i < walk.size(); ++i) {
      if (walk[i] != WorldStore::kNoSlot) removeObject(m_p_store->object(walk[i]));
    }
  }
  if (t_p_current == this) t_p_current = nullptr;
  m_p_store->orphan();
  m_p_store->release();
}

World& World::current() {
  if (t_p_current != nullptr) return *t_p_current;
  static World* p_default = [] {
    auto* p_world = new World;  // for ever: static Objects of games may die later than anything of ours
    p_world->m_is_default = true;
    return p_world;
  }();
  return *p_default;
}

WorldScope::WorldScope(World& world) : m_p_before(std::exchange(t_p_current, &world)) {}

WorldScope::~WorldScope() {
  t_p_current = m_p_before;
}

// Time.

void World::tick() {
  if (m_in_tick || m_in_update || m_in_draw) return;
  const Scope scope(*this);
  m_begun = true;
  {
    const During during(m_in_tick);
    ++m_step_count;
    learnNewcomers();
    m_capture->clearPicture();
    if (m_p_extras != nullptr) m_p_extras->beginTick();
    if (!isPaused()) {
      const EventStep step(m_compat ? m_step_count - 1 : m_step_count);
      onEvent(&step);
      if (m_p_extras != nullptr) m_p_extras->walkers.step();
    }
    if (!isPaused()) beginControlTick(*this);
    drainInput();
    if (!isPaused()) update();
    drawObjects();
    m_capture->finishView();
    if (m_p_extras != nullptr) m_p_extras->endTick();
  }
  finishShutDown();
}

void World::update() {
  if (m_in_update) return;
  const Scope scope(*this);
  m_begun = true;
  {
    const During during(m_in_update);
    learnNewcomers();
    m_mover->moveAll();
    for (std::size_t i = 0; i < m_layers.size(); ++i) m_layers[i]->step(*this);  // handlers may add one
    deleteMarked();
    m_p_store->closeGaps();
    m_p_store->age();
  }
  finishShutDown();
}

void World::place(ObjectKey key, FixedVector where) {
  m_mover->place(key, where);
}

void World::draw() {
  if (m_in_tick || m_in_draw) return;
  const Scope scope(*this);
  m_capture->clearPicture();
  drawObjects();
  finishShutDown();
}

void World::drawObjects() {
  const During during(m_in_draw);
  m_capture->drawAll();
}

void World::run() {
  // A handler that ran the game would wait for ticks that cannot begin before it returns.
  if (m_in_tick || m_in_update || m_in_draw) {
    logOnce("GM.run() inside a handler does nothing: the game is running");
    return;
  }
  const Scope scope(*this);
  m_begun = true;
  if (m_p_runner != nullptr) {
    m_p_runner->run(*this);
    return;
  }
  // Many games show a title in a run of its own, which ends with the game over, and then run again.
  if (isStarted(kGameHasRun)) m_game_over = false;
  if (isStarted(kGameStarted)) setStarted(kGameHasRun, true);
  if (running::Program* p_program = program()) return p_program->run(*this);
  while (!m_game_over) tick();
}

running::Program* World::program() const {
  return m_p_runner == nullptr && m_is_default ? running::program() : nullptr;
}

void World::setGameOver(bool game_over) {
  if (game_over && m_game_over_leaves && m_input_player != 0) {
    m_leavers.push_back(m_input_player);
  } else {
    m_game_over = game_over;
  }
}

void World::setSeed(std::uint64_t seed) {
  m_seed = seed;
  m_random = Random(seed);
}

void World::setStarted(unsigned manager, bool started) {
  m_started = started ? m_started | manager : m_started & ~manager;
}

// Events.

int World::onEvent(const Event* p_event) {
  if (p_event == nullptr) return 0;
  if (&p_event->getType() == &UNDEFINED_EVENT)
    logOnce("WM.onEvent() of a " + classNameOf(typeid(*p_event)) +
            " without a type: setType() was forgotten");
  const Scope scope(*this);
  // Joins and leaves during a pause count when the game goes on.
  const EventType& type = p_event->getType();
  const bool stays = isPaused() && type != JOIN_EVENT && type != LEAVE_EVENT;
  return m_interests->send(*p_event, stays ? Interests::kWhilePaused : Interests::kAll);
}

bool World::deliver(ObjectKey key, const Event& event) {
  const WorldStore& store = *m_p_store;
  constexpr std::uint32_t kThere = WorldStore::kInWorld | WorldStore::kActive;
  if (!store.isCurrent(key) || (store.flags(key.slot) & kThere) != kThere) return false;
  if (store.hears(key.slot)) runHandler(key, *store.object(key.slot), event);
  return true;
}

void World::learnNewcomers() {
  for (const ObjectKey key : m_p_store->takeNewcomers()) {
    if (m_p_store->isCurrent(key)) learnType(key.slot);
  }
}

// The constructors of Object could not know what is derived from it.
void World::learnType(std::uint32_t slot) {
  const Object& object = *m_p_store->object(slot);
  if (m_p_page != nullptr) nameClass(slot);
  m_p_store->set(slot, WorldStore::kTyped, true);
  m_p_store->set(slot, WorldStore::kNeverDraws, typeid(object) == typeid(Object));
  const bool deaf = object.isDeaf();
  m_p_store->set(slot, WorldStore::kDeaf, deaf);
  if (deaf && !object.m_p_profile->interests.empty() && typeid(object) != typeid(Object)) {
    logOnce(nameOf(object) +
            " registers interest in events and has no eventHandler() that gets them: it must be declared "
            "\"int eventHandler(const df::Event*) override\"");
  }
}

// ---- what a report on a crash needs -----------------------------------------------------------------------

void World::setActivityPage(ActivityPage* p_page) {
  m_p_page = p_page;
  m_p_activity = p_page != nullptr ? &p_page->now : m_own_activity.get();
  m_named_event = 0;
  if (p_page == nullptr) return;
  const WorldStore::Walk walk(*m_p_store);
  for (std::size_t i = 0; i < walk.size(); ++i) {
    if (walk[i] != WorldStore::kNoSlot && m_p_store->has(walk[i], WorldStore::kTyped)) nameClass(walk[i]);
  }
  // Those that are sent without onEvent().
  nameEvent(EventCollision());
  nameEvent(EventOut());
}

void World::nameClass(std::uint32_t slot) {
  const Object& object = *m_p_store->object(slot);
  m_p_page->addName(classOf(object), typeid(object).name());
}

void World::nameEvent(const Event& event) {
  m_named_event = classOf(event);
  m_p_page->addName(m_named_event, typeid(event).name());
}

void World::quarantine(ObjectKey key, const std::string& why) {
  Object* p_o = find(key);
  log("An object" + (p_o != nullptr ? " of type " + nameOf(*p_o) : std::string()) +
      " failed and is taken out of the game: " + why);
  if (p_o == nullptr) return;
  p_o->setActive(false);
  markForDelete(p_o);
}

}  // namespace df
