#include <cstdint>

#include "../Scene.h"
#include "Book.h"
#include "Textbook.h"

namespace textbook {
namespace {

class Ball : public Object {
 public:
  Ball(const bench::Body& body, std::uint64_t number, float side, bench::Tally& tally)
      : m_tally(tally), m_number(number), m_side(side) {
    setType("Ball");
    setSolidness(body.solidness == df::HARD ? HARD : body.solidness == df::SOFT ? SOFT : SPECTRAL);
    setPosition(Vector(static_cast<float>(body.x), static_cast<float>(body.y)));
    setVelocity(Vector(static_cast<float>(body.vx), static_cast<float>(body.vy)));
  }

  int eventHandler(const Event* p_e) override {
    if (p_e->getType() == COLLISION_EVENT) return hit(static_cast<const EventCollision*>(p_e));
    if (p_e->getType() != OUT_EVENT) return 0;
    bench::turnBack(*this, m_side);
    return 1;
  }

 private:
  int hit(const EventCollision* p_e) {
    m_tally.event(m_number);
    const bool is_mover = p_e->getObject1() == this;
    if (!is_mover || getSolidness() != HARD || p_e->getObject2()->getSolidness() != HARD) return 1;
    if (m_turned == m_tally.tick) return 1;  // it collided with several boxes in this tick
    m_turned = m_tally.tick;
    ++m_tally.blocked;
    bench::reverse(*this);
    return 1;
  }

  bench::Tally& m_tally;
  std::uint64_t m_number;
  std::uint64_t m_turned = 0;  // last tick in which it was blocked
  float m_side;
};

class TextbookEngine : public bench::Engine {
 public:
  TextbookEngine(const bench::Scene& scene, int turns) : m_turns(turns) {
    const auto side = static_cast<float>(scene.side);
    WM.setBoundary(Vector(side, side));
    std::uint64_t number = 0;
    for (const bench::Body& body : scene.bodies) new Ball(body, number++, side, m_tally);
  }
  TextbookEngine(const TextbookEngine&) = delete;
  TextbookEngine& operator=(const TextbookEngine&) = delete;
  ~TextbookEngine() override { WM.shutDown(); }

  void tick() override {
    ++m_tally.tick;
    if (m_turns >= WM.getCount()) {
      WM.update();
    } else {
      updateSome();
    }
  }

  const bench::Tally& tally() const override { return m_tally; }
  double partOfTick() const override { return static_cast<double>(m_turns) / WM.getCount(); }

  std::uint64_t stateHash() const override {
    bench::StateHash hash;
    for (int i = 0; i < WM.getCount(); i++) {
      hash.add(WM.getObject(i)->getPosition().getX());
      hash.add(WM.getObject(i)->getPosition().getY());
      hash.add(WM.getObject(i)->getVelocity().getX());
      hash.add(WM.getObject(i)->getVelocity().getY());
    }
    return hash.value();
  }

 private:
  // Like update(), but only for m_turns Objects, evenly spaced in the list.
  void updateSome() {
    const int distance = WM.getCount() / m_turns;
    const int first = static_cast<int>(m_tally.tick) % distance;
    for (int turn = 0; turn < m_turns; turn++) {
      Object* p_o = WM.getObject(first + turn * distance);
      const Vector new_pos = p_o->predictPosition();
      if (new_pos != p_o->getPosition()) WM.moveObject(p_o, new_pos);
    }
  }

  bench::Tally m_tally;
  int m_turns;
};

}  // namespace

bench::EnginePtr makeEngine(const bench::Scene& scene, int turns) {
  return std::make_unique<TextbookEngine>(scene, turns);
}

}  // namespace textbook
