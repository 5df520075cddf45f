#include "engine/world/World.h"

#include <utility>

#include "engine/world/Capture.h"
#include "engine/world/EventDispatch.h"
#include "engine/world/InputQueue.h"
#include "engine/world/Interests.h"
#include "engine/world/Mover.h"
#include "engine/world/Object.h"
#include "engine/world/ObjectRegistry.h"
#include "engine/world/Started.h"
#include "engine/world/Tick.h"
#include "engine/world/Views.h"
#include "engine/world/WorldExtras.h"
#include "engine/world/WorldLog.h"
#include "engine/world/WorldStore.h"

namespace df {

namespace {

thread_local World* t_p_current = nullptr;

}  // namespace

World::World()
    : m_p_store(new WorldStore(this)),
      m_log(std::make_unique<WorldLog>()),
      m_extras(std::make_unique<LazyExtras>(*m_p_store, *m_log, m_state)),
      m_interests(std::make_unique<Interests>(*m_p_store)),
      m_objects(std::make_unique<ObjectRegistry>(*m_p_store, *m_interests, *m_log)),
      m_events(
          std::make_unique<EventDispatch>(*m_objects, *m_interests, m_state, [this] { finishShutDown(); })),
      m_views(std::make_unique<Views>(*m_p_store, *m_log)),
      m_picture(std::make_unique<Capture>(*m_p_store, *m_views, *m_events, *m_extras, m_state)),
      m_mover(std::make_unique<Mover>(*m_objects, *m_views, *m_events, m_state)),
      m_input(std::make_unique<InputQueue>(*m_objects, *m_views, *m_events, *m_mover, *m_extras, m_state)),
      m_tick(std::make_unique<Tick>(*this, *m_objects, *m_events, *m_picture, *m_mover, *m_input, *m_extras,
                                    m_state)) {}

World::~World() {
  {
    const WorldStore::Walk walk(*m_p_store);
    for (std::size_t i = 0; i < walk.size(); ++i) {
      if (walk[i] != WorldStore::kNoSlot) m_objects->removeObject(m_p_store->object(walk[i]));
    }
  }
  if (t_p_current == this) t_p_current = nullptr;
  m_p_store->detachWorld();
  m_p_store->release();
}

World& World::current() {
  if (t_p_current != nullptr) return *t_p_current;
  static World* p_default = [] {
    auto* p_world = new World;  // never destroyed: static Objects of games may be destroyed last
    p_world->m_state.is_default = true;
    return p_world;
  }();
  return *p_default;
}

WorldScope::WorldScope(World& world) : m_p_before(std::exchange(t_p_current, &world)) {}

WorldScope::~WorldScope() {
  t_p_current = m_p_before;
}

bool World::isBusy() const {
  return m_tick->isRunning() || m_events->isRunning();
}

void World::shutDown() {
  if (isBusy()) {
    m_events->deferShutDown();
    m_state.game_over = true;
    return;
  }
  const Scope scope(*this);
  m_objects->clear();
  m_views->reset();
  m_input->clear();
  m_log->clear();
  if (WorldExtras* p_extras = findExtras()) p_extras->reset();
  static_cast<RoundState&>(m_state) = RoundState();
  m_state.random = Random(m_state.seed);
}

void World::finishShutDown() {
  if (isBusy() || !m_events->popShutDown()) return;
  shutDown();
  m_state.game_over = true;  // ends the running loop; GM.startUp() starts again
}

void World::tick() {
  const Scope scope(*this);
  m_tick->run();
  finishShutDown();
}

void World::update() {
  const Scope scope(*this);
  m_tick->update();
  finishShutDown();
}

void World::draw() {
  const Scope scope(*this);
  m_tick->draw();
  finishShutDown();
}

bool World::isDrawing() const {
  return m_tick->isDrawing();
}

void World::run() {
  // A handler that calls run() would wait for ticks that cannot begin before the handler returns.
  if (m_tick->isRunning()) {
    m_log->writeOnce("GM.run() inside a handler does nothing: the game is running");
    return;
  }
  const Scope scope(*this);
  m_state.begun = true;
  if (m_state.p_runner != nullptr) {
    m_state.p_runner->run(*this);
    return;
  }
  // Many games first run a title, which ends with a game over, and then run the game.
  if (isStarted(kGameHasRun)) m_state.game_over = false;
  if (isStarted(kGameStarted)) setStarted(kGameHasRun, true);
  if (running::Program* p_program = program()) return p_program->run(*this);
  while (!m_state.game_over) tick();
}

running::Program* World::program() const {
  return m_state.p_runner == nullptr && m_state.is_default ? running::program() : nullptr;
}

void World::setGameOver(bool game_over) {
  if (!game_over || !m_input->handleGameOver()) m_state.game_over = game_over;
}

int World::drawCh(Vector world_pos, char32_t ch, Color color) {
  const auto position = toFixed(world_pos);
  if (!position || color < BLACK || color > WHITE) return m_log->refuse("DisplayManager", "drawCh");
  m_picture->add(*position, ch, color);
  return 0;
}

void World::drawFrame(std::uint32_t slot) {
  m_picture->addFrame(slot);
}

Box World::getView() const {
  return m_views->viewOf(m_views->player(m_input->player()));
}

WorldExtras& World::extras() {
  return m_extras->get();
}

WorldExtras* World::findExtras() const {
  return m_extras->find();
}

void World::setActivityPage(ActivityPage* p_page) {
  m_log->setPage(p_page);
  m_events->setPage(p_page);
}

void World::deliver(ObjectKey key, const Event& event) {
  m_events->nameClassOf(event);
  m_events->deliver(key, event);
}

void World::setWalking(Object& object, bool walks) {
  m_tick->pathFollowers().set(object, walks);
}

void World::recordSound(SoundPlayed sound) {
  sound.player = m_input->player();
  extras().recordSound(std::move(sound));
}

bool World::isPlaying(const std::string& label, bool music) {
  return extras().isPlaying(label, music);
}

bool World::findFile(const std::string& kind, const std::string& filename) {
  const Resources& resources = extras().resources;
  if (resources.open(filename)) return true;
  m_log->write(kind + ": " + filename + ": cannot be read" + resources.searchedFolders(filename));
  return false;
}

}  // namespace df
