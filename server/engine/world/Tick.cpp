#include "engine/world/Tick.h"

#include <algorithm>

#include "engine/events/EventStep.h"
#include "engine/world/Capture.h"
#include "engine/world/ControlApplier.h"
#include "engine/world/EventDispatch.h"
#include "engine/world/InputQueue.h"
#include "engine/world/Mover.h"
#include "engine/world/Object.h"
#include "engine/world/ObjectExtras.h"
#include "engine/world/ObjectRegistry.h"
#include "engine/world/WorldExtras.h"
#include "engine/world/WorldState.h"
#include "engine/world/WorldStore.h"

namespace df {

namespace {

// Sets a flag while this object exists.
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

PathFollowers::~PathFollowers() {
  for (Object* p_o : m_objects) p_o->m_p_extras->follows_path = false;
}

void PathFollowers::set(Object& object, bool walks) {
  const auto place = std::find(m_objects.begin(), m_objects.end(), &object);
  if (walks && place == m_objects.end()) m_objects.push_back(&object);
  if (!walks && place != m_objects.end()) m_objects.erase(place);
}

void PathFollowers::step() {
  const std::vector<Object*> walkers = m_objects;  // a copy, because Objects that arrive remove themselves
  for (Object* p_o : walkers) turn(*p_o);
}

// If the next step would pass a node, a shorter one ends exactly there: the Object turns where the path does.
void PathFollowers::turn(Object& object) {
  if (!object.m_p_store->has(object.m_slot, WorldStore::kInWorld) || !object.isActive()) return;
  ObjectExtras& extras = *object.m_p_extras;
  Path& path = extras.path;
  while (!path.getPath().empty() && path.nextNode() == object.getPosition()) {
    if (path.endOfPath()) {
      object.setFollowPath(false);
      object.setVelocity(Vector());
      return;
    }
    path++;
  }
  const double speed = extras.path_speed > 0 ? extras.path_speed : object.getSpeed();
  if (path.getPath().empty() || !(speed > 0)) return;
  extras.path_speed = speed;
  Vector displacement = path.nextNode() - object.getPosition();
  const double left = displacement.getMagnitude();
  if (left > speed) displacement.scale(speed / left);
  object.setVelocity(displacement);
}

Tick::Tick(World& world, ObjectRegistry& objects, EventDispatch& events, Capture& picture, Mover& mover,
           InputQueue& input, LazyExtras& extras, WorldState& state)
    : m_world(world),
      m_objects(objects),
      m_events(events),
      m_picture(picture),
      m_mover(mover),
      m_input(input),
      m_extras(extras),
      m_state(state) {}

void Tick::run() {
  if (isRunning()) return;
  m_state.begun = true;
  const During during(m_in_tick);
  ++m_state.step_count;
  m_events.classifyNewObjects();
  m_picture.clearPicture();
  if (WorldExtras* p_extras = m_extras.find()) p_extras->beginTick(m_state.step_count);
  if (!m_state.paused) {
    const EventStep step(m_state.compat ? m_state.step_count - 1 : m_state.step_count);
    m_events.onEvent(&step);
    m_path_followers.step();
  }
  if (!m_state.paused) ControlApplier::beginTick(m_mover);
  m_input.drain();
  if (!m_state.paused) update();
  drawObjects();
  m_picture.finishView();
  if (WorldExtras* p_extras = m_extras.find()) p_extras->endTick(m_state.paused);
}

void Tick::update() {
  if (m_in_update) return;
  m_state.begun = true;
  const During during(m_in_update);
  m_events.classifyNewObjects();
  m_mover.moveAll();
  // A step may add a layer.
  for (std::size_t i = 0; i < m_state.layers.size(); ++i) m_state.layers[i]->step(m_world);
  m_objects.deleteMarked();
  m_objects.store().closeGaps();
  m_objects.store().age();
}

void Tick::draw() {
  if (m_in_tick || m_in_draw) return;
  m_picture.clearPicture();
  drawObjects();
}

void Tick::drawObjects() {
  const During during(m_in_draw);
  m_picture.drawAll();
}

}  // namespace df
