// Finds bodies that may touch: pairs with overlapping bounds, kept from step to step and sorted by ids.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "physics/broadphase/BroadPhaseBounds.h"
#include "physics/broadphase/ImpactTree.h"

namespace naiad::physics {

/// Two bodies with overlapping bounds; id_a < id_b.
struct BroadPhasePair {
  std::uint32_t id_a;
  std::uint32_t id_b;
  std::int32_t proxy_a;
  std::int32_t proxy_b;
  friend constexpr bool operator==(const BroadPhasePair& a, const BroadPhasePair& b) = default;
};

/// The bounds of a body are wider than itself, so small moves change nothing and cost one comparison. A body
/// at rest costs nothing. After a warm-up this class does not allocate. Not thread-safe.
class BroadPhase {
 public:
  /// With `thins_crowds`, a body is in a crowd if the centres of more than 32 others are nearer to its own
  /// than the smaller body of the pair is wide. It finds only the nearest 16 of these and of the others that
  /// are about as large as itself, and the nearest 16 larger ones. So the cost grows with the number of
  /// bodies, not of pairs.
  explicit BroadPhase(bool thins_crowds = false) : m_thins_crowds(thins_crowds) {}

  /// Adds a body. Returns its proxy, the number used below, which is valid until remove(). `id` is chosen by
  /// the caller and unique. `moves` is false for bodies that never move: two of these make no pair. In a
  /// crowd, `order` decides between bodies at equal distance, because results must not depend on reused ids.
  std::int32_t add(std::uint32_t id, const GridBounds& wide, bool moves, std::uint64_t order = 0);
  void remove(std::int32_t proxy);

  /// Moves a body to `tight`. If its present bounds contain `tight`, they stay; otherwise they become `wide`,
  /// which is `tight` with room for later moves. Returns true if they became `wide`.
  bool move(std::int32_t proxy, const GridBounds& tight, const GridBounds& wide);
  /// Sets the bounds of a body, even if its present bounds contain them.
  void set(std::int32_t proxy, const GridBounds& bounds);
  const GridBounds& bounds(std::int32_t proxy) const { return m_proxies[index(proxy)].bounds; }

  /// Returns all pairs with overlapping bounds, ordered by (id_a, id_b), valid until the next call. The cost
  /// depends on the number of bodies added, removed or given new bounds since the last call.
  std::span<const BroadPhasePair> updatePairs();

  /// Calls visit(id) for every body whose bounds overlap `bounds`, in an unspecified but reproducible order.
  template <class Visit>
  void query(const GridBounds& bounds, Visit&& visit) {
    if (isUntidy()) fileAll();
    const SweptBox box = relative(bounds);
    visitAll(
        bounds, [&](const ImpactTree::Below& below) { return overlaps(below.box, box); },
        [&](std::int32_t proxy) { visit(m_proxies[index(proxy)].id); }, kNone);
  }
  /// True if some pairs of this proxy are missing because it is in a crowd.
  bool isThinned(std::int32_t proxy) const { return m_proxies[index(proxy)].is_thinned; }
  /// True if isThinned() was true for any proxy since construction.
  bool hasThinned() const { return m_has_thinned; }
  /// Number of pairs tested since construction.
  std::int64_t looks() const { return m_looks; }

 private:
  struct Proxy {
    std::uint32_t id;
    bool moves;
    bool changed;  // listed in m_changed
    bool is_removed;
    bool is_filed;  // its bounds are within those in the tree; if false, it is in m_loose or removed
    bool is_thinned;
    std::uint32_t heaped;  // number of its pairs of kind kHeaped, set by findAllPairs(); kCrowd near a crowd
    std::uint64_t order;
    GridBounds bounds;
  };
  static std::size_t index(std::int32_t proxy) { return static_cast<std::size_t>(proxy); }
  struct Heaped {
    double square;        // square of twice the distance of the centres
    std::uint64_t order;  // order of the other body
    BroadPhasePair pair;
  };
  // A summary of all bodies below a node of the tree.
  struct Crowd {
    SweptBox middles;           // box around the centres of their bounds
    Vec2 narrowest, widest;     // least and largest widths; `widest` is infinite if a body never moves
    Vec2 widths;                // sum of the bodies' widths
    std::uint64_t first, last;  // minimum and maximum of `order`; in `last`, kLastOrder for unchanged bodies
  };
  void markChanged(std::int32_t proxy);
  SweptBox relative(const GridBounds& bounds) const;
  float halfOf(const Proxy& proxy) const;
  void fileAll();
  // True if updating the tree is worth its cost: too many bodies are outside it, or their boxes in it grew.
  bool isUntidy() const {
    return m_loose.size() * m_loose.size() > kScannedPerBody * m_count || kWidenedShare * m_widened > m_count;
  }
  static constexpr std::int32_t kNone = -1;
  // Visits bodies below the tree's nodes that enters() accepts, first near `beside`, then those outside it.
  template <class Enters, class Visit>
  void visitAll(const GridBounds& bounds, Enters&& enters, Visit&& visit, std::int32_t beside) const {
    const auto visitFiled = [&](int proxy) {
      const Proxy& own = m_proxies[index(proxy)];
      if (own.is_filed && overlap(own.bounds, bounds)) visit(proxy);
    };
    m_tree.walk(enters, visitFiled, beside);
    for (const std::int32_t proxy : m_loose) {
      const Proxy& own = m_proxies[index(proxy)];
      if (!own.is_removed && overlap(own.bounds, bounds)) visit(proxy);
    }
  }
  void findPairs(std::int32_t proxy);
  bool isCrowd(const ImpactTree::Below& below) const;
  void findCrowds();
  void summarizeCrowds();
  void findAllPairs();
  // Relation of two moving bodies. kHeaped: their centres are nearer than the smaller one is wide. kAlike:
  // about equally large. kUnlike: neither. kOther: one never moves, or crowds are not thinned.
  enum class Kind : std::uint8_t { kOther, kHeaped, kAlike, kUnlike };
  Kind kindOf(const Proxy& a, const Proxy& b) const;
  std::int32_t finderOf(std::int32_t a, std::int32_t b, Kind kind) const;
  bool isBefore(std::int32_t a, std::int32_t b) const;
  bool isSmaller(std::int32_t a, std::int32_t b) const;
  bool isInCrowd(std::int32_t proxy);
  // The candidates found for one body, of which only the nearest are kept.
  struct Nearest {
    std::vector<Heaped> found;
    double farthest = 0;     // largest Heaped::square still accepted
    std::uint64_t last = 0;  // largest order accepted at that square
    void clear();
    void keep();
  };
  void sortFound();

  // Refitting the tree takes about as long as comparing this many bounds per body.
  static constexpr std::size_t kScannedPerBody = 8;
  // The tree is updated if bounds in it were widened more than once per this many bodies.
  static constexpr std::size_t kWidenedShare = 4;

  bool m_thins_crowds;
  bool m_has_thinned = false;
  bool m_was_crowded = false;
  std::int64_t m_looks = 0;
  std::vector<Proxy> m_proxies;
  std::vector<std::int32_t> m_free;
  std::vector<std::int32_t> m_changed;
  std::size_t m_count = 0;  // number of bodies
  std::vector<BroadPhasePair> m_pairs, m_found, m_spare;
  Nearest m_heaped, m_larger;
  ImpactTree m_tree;      // by proxy: the bounds at the last fileAll(), in grid units
  GridBounds m_origin{};  // origin of the tree's coordinates
  std::vector<SweptBox> m_boxes;
  std::vector<float> m_halves;  // half of the shorter side; 0 if the body never moves, or no crowd is thinned
  std::vector<int> m_numbers;
  std::vector<Crowd> m_crowds;        // by node of the tree, while pairs of a crowd are found
  std::vector<std::int32_t> m_loose;  // bodies added or moved away since the last fileAll()
  std::size_t m_widened = 0;          // number of bounds widened in the tree since the last fileAll()
};

}  // namespace naiad::physics
