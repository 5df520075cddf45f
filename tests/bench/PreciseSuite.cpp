// The cost of comparing characters, and the correctness of the answers.
//
// Precise Objects with masks fly about (WM.update) and turn around when blocked. Then WM.getCollisions finds
// the collisions of each at its position, once precisely and once with boxes only. The difference of the
// times, divided by the number of pairs whose boxes touch, is the cost of comparing the characters of a pair.
// All results are compared with those of a simple loop over all characters.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <vector>

#include "Contest.h"
#include "ElapsedTime.h"
#include "RandomMask.h"
#include "ResultLine.h"
#include "Scene.h"
#include "SortedBoxes.h"
#include "Suite.h"
#include "engine/events/EventOut.h"
#include "engine/managers/WorldManager.h"
#include "engine/world/EventCollision.h"
#include "engine/world/Object.h"
#include "shared/values/SplitMix64.h"
#include "tests/server/engine/oracle/OracleGeometry.h"
#include "tests/support/LoggedWorld.h"

namespace bench {
namespace {

constexpr double kDensity = 0.5;
constexpr int kWidest = 12;

class Sprite : public df::Object {
 public:
  Sprite(const oracle::Mask& its_mask, df::Vector corner, df::Vector velocity) : mask(its_mask) {
    setBox(df::Box(df::Vector(), static_cast<double>(mask[0].size()), static_cast<double>(mask.size())));
    setMask(mask);
    setPrecise();
    setPosition(corner);
    setVelocity(velocity);
  }

  int eventHandler(const df::Event* p_e) override {
    if (p_e->getType() == df::OUT_EVENT) {
      setPosition(getPosition() - getVelocity());
      reverse(*this);
    } else if (p_e->getType() == df::COLLISION_EVENT) {
      if (static_cast<const df::EventCollision*>(p_e)->getObject1() == this) reverse(*this);
    }
    return 1;
  }

  df::FixedBox box() const {
    const df::FixedVector corner = df::toFixed(getPosition()).value_or(df::FixedVector{});
    return {corner, {std::ssize(mask[0]) * df::kFixedOne, std::ssize(mask) * df::kFixedOne}};
  }

  const oracle::Mask mask;
};

// The result for one arrangement of the Objects.
struct Verdict {
  long pairs = 0;  ///< pairs whose boxes touch
  long mismatches = 0;
};

class Crowd {
 public:
  explicit Crowd(int n) {
    naiad::SplitMix64 random(20240607);
    std::vector<oracle::Mask> looks;
    double area = 0;
    for (int i = 0; i < n; ++i) {
      looks.push_back(randomMask(random));
      area += static_cast<double>(looks.back()[0].size() * looks.back().size());
    }
    m_side = std::ceil(std::sqrt(area / kDensity));
    WM.setBoundary(df::Box(df::Vector(), m_side, m_side));
    const auto between = [&random](double least, double most) {
      return least + (most - least) * random.unit();
    };
    for (const oracle::Mask& look : looks) {
      const double x = between(0, m_side);
      const double y = between(0, m_side);
      const double speed_x = between(-1, 1);
      const double speed_y = between(-1, 1);
      m_sprites.push_back(new Sprite(look, df::Vector(x, y), df::Vector(speed_x, speed_y)));
    }
  }

  /// Moves all sprites for a tick. Returns the time per Object.
  double tick() {
    return timePerObject([] { WM.update(); });
  }

  /// Finds the collisions of all sprites. Returns the time per Object.
  double askAll(bool precise) {
    for (Sprite* p_sprite : m_sprites) p_sprite->setPrecise(precise);
    const double time = timePerObject([this] {
      for (const Sprite* p_sprite : m_sprites)
        m_found += WM.getCollisions(p_sprite, p_sprite->getPosition()).getCount();
    });
    for (Sprite* p_sprite : m_sprites) p_sprite->setPrecise();
    return time;
  }

  Verdict judge() const {
    std::vector<df::FixedBox> boxes;
    for (const Sprite* p_sprite : m_sprites) boxes.push_back(p_sprite->box());
    const SortedBoxes sorted(boxes, kWidest);
    Verdict verdict;
    for (std::size_t i = 0; i < m_sprites.size(); ++i) judge(i, boxes, sorted, verdict);
    return verdict;
  }

 private:
  template <class Do>
  double timePerObject(Do run) const {
    const double begin = cpuNanoseconds();
    run();
    return (cpuNanoseconds() - begin) / static_cast<double>(m_sprites.size());
  }

  // Counts the pairs of sprite i that are missing in the engine's list or wrongly in it.
  void judge(std::size_t i, const std::vector<df::FixedBox>& boxes, const SortedBoxes& sorted,
             Verdict& verdict) const {
    std::vector<const df::Object*> right;
    sorted.near(boxes[i], [&](std::uint32_t other) {
      if (other == i || !oracle::boxIntersectsBox(boxes[i], boxes[other])) return;
      ++verdict.pairs;
      if (oracle::shareCell(boxes[i], m_sprites[i]->mask, boxes[other], m_sprites[other]->mask))
        right.push_back(m_sprites[other]);
    });
    std::vector<const df::Object*> ours;
    const df::ObjectList list = WM.getCollisions(m_sprites[i], m_sprites[i]->getPosition());
    for (df::ObjectListIterator it(&list); !it.isDone(); it.next()) ours.push_back(it.currentObject());
    std::sort(right.begin(), right.end());
    std::sort(ours.begin(), ours.end());
    std::vector<const df::Object*> wrong;
    std::set_symmetric_difference(right.begin(), right.end(), ours.begin(), ours.end(),
                                  std::back_inserter(wrong));
    verdict.mismatches += static_cast<long>(wrong.size());
  }

  df::test::LoggedWorld m_own;
  double m_side = 0;
  std::vector<Sprite*> m_sprites;  // owned by the world
  long m_found = 0;
};

void measure(int n, const Options& options) {
  progress("precise: " + std::to_string(n));
  const long pairs = options.quick ? 20'000 : 600'000;
  Crowd crowd(n);
  for (int i = 0; i < 10; ++i) crowd.tick();
  Verdict all;
  std::vector<double> tests;
  std::vector<double> queries;
  std::vector<double> ticks;
  while (all.pairs < pairs || ticks.size() < 5) {
    ticks.push_back(crowd.tick());
    const Verdict verdict = crowd.judge();
    all.pairs += verdict.pairs;
    all.mismatches += verdict.mismatches;
    const double boxes_only = crowd.askAll(false);
    queries.push_back(crowd.askAll(true));
    tests.push_back((queries.back() - boxes_only) * n / static_cast<double>(verdict.pairs));
  }
  Line("precise")
      .add("n", n)
      .add("ns_per_test", median(tests))
      .addZero("mismatches", all.mismatches)
      .add("pairs", static_cast<long long>(all.pairs))
      .add("pairs_per_object", static_cast<double>(all.pairs) / static_cast<double>(ticks.size()) / n)
      .add("ns_per_query", median(queries))
      .add("ns_per_object", median(ticks));
}

const Suite s_suite("precise", "comparing characters: cost of a test, and is it right?",
                    [](const Options& options) {
                      for (const int n : {1000, 10'000}) measure(n, options);
                    });

}  // namespace
}  // namespace bench
