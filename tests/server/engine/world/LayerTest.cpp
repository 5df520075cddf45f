#include <memory>

#include "engine/events/EventStep.h"
#include "engine/world/Layer.h"
#include "tests/server/engine/Probe.h"

namespace df {
namespace {

/// A layer that lets its bodies fall: each tick moves them by their velocity plus half a tick's gravity.
class Falling : public Layer {
 public:
  void step(World& world) override {
    ++steps;
    for (const ObjectKey key : bodies) {
      if (world.store().find(key) == nullptr) continue;
      WorldStore& store = world.store();
      const FixedVector v = store.velocity(key.slot);
      const FixedVector a{0, fromCells(1) / 4};
      store.setPosition(key.slot, store.position(key.slot) + v + FixedVector{0, a.y / 2});
      store.setVelocity(key.slot, v + a);
      store.setAcceleration(key.slot, a);
    }
  }
  void add(const Object& object) {
    bodies.push_back(object.key());
    object.getWorld()->store().set(object.key().slot, WorldStore::kBody, true);
  }
  int steps = 0;
  std::vector<ObjectKey> bodies;
};

/// A layer whose step is a function.
struct StepLayer : Layer {
  explicit StepLayer(std::function<void(World&)> its_step) : on_step(std::move(its_step)) {}
  void step(World& world) override { on_step(world); }
  std::function<void(World&)> on_step;
};

class Layers : public test::WorldTest {
 protected:
  Layers() {
    world.addLayer(std::make_unique<Falling>());
    layer = world.findLayer<Falling>();
  }
  Falling* layer = nullptr;
};

TEST_F(Layers, FoundByClassAndSteppedOncePerUpdate) {
  class Other : public Falling {};
  ASSERT_NE(layer, nullptr);
  EXPECT_EQ(world.findLayer<Other>(), nullptr);
  world.update();
  world.tick();
  EXPECT_EQ(layer->steps, 2);
}

TEST_F(Layers, OnlyTheLayerMovesItsBodies) {
  Object body, plain;
  layer->add(body);
  for (Object* p_object : {&body, &plain}) {
    p_object->setSolidness(SPECTRAL);
    p_object->setVelocity(Vector(1, 0));
  }
  world.update();
  EXPECT_EQ(body.getPosition(), Vector(1, 0.125)) << "by the layer, once";
  EXPECT_EQ(plain.getPosition(), Vector(1, 0));
  body.setActive(false);
  body.setActive(true);
  world.store().set(body.key().slot, WorldStore::kBody, false);
  layer->bodies.clear();
  world.update();
  EXPECT_EQ(body.getPosition(), Vector(2, 0.375)) << "no body any more: the book's";
}

TEST_F(Layers, ABodyBlocksOthers) {
  Object body, plain;
  layer->add(body);
  layer->bodies.clear();  // the layer no longer moves the body
  body.setPosition(Vector(5, 0));
  plain.setVelocity(Vector(1, 0));
  for (int i = 0; i < 10; ++i) world.update();
  EXPECT_EQ(plain.getPosition(), Vector(3, 0));
}

TEST_F(Layers, StepMarkedObjectIsDeletedInTheSameUpdate) {
  const ObjectKey key = (new Object)->key();
  world.addLayer(
      std::make_unique<StepLayer>([key](World& its) { its.objects().markForDelete(its.store().find(key)); }));
  world.update();
  EXPECT_EQ(world.store().find(key), nullptr);
}

class TickAlone : public test::WorldTest {
 protected:
  TickAlone() {
    probe.registerInterest(STEP_EVENT);
    probe.registerInterest(KEYBOARD_EVENT);
    probe.on_draw = [this](test::Probe&) { received.push_back("draw"); };
    world.addLayer(std::make_unique<StepLayer>([this](World& /*its*/) { received.push_back("layer"); }));
    ann = joined("ann");
    received.clear();
  }

  test::Probe probe{"probe", &received};
  std::uint32_t ann = 0;
};

TEST_F(TickAlone, StagesRunInOrderAndPausedTickOnlyDraws) {
  pressedBy({ann}, Keyboard::A);
  EXPECT_EQ(received, (test::Received{"probe:df-step", "probe:df-keyboard", "layer", "draw"}));
  EXPECT_EQ(world.getStepCount(), 2);
  world.setPaused(true);
  received.clear();
  world.tick();
  EXPECT_EQ(received, test::Received{"draw"});
}

}  // namespace
}  // namespace df
