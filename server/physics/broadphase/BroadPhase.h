// Which bodies may touch: pairs of bounds that overlap, kept from step to step and listed in the order of
// ids.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "physics/broadphase/BroadPhaseBounds.h"
#include "physics/broadphase/ImpactTree.h"

namespace naiad::physics {

/// Bodies whose bounds overlap. id_a < id_b.
struct BroadPhasePair {
  std::uint32_t id_a;
  std::uint32_t id_b;
  std::int32_t proxy_a;
  std::int32_t proxy_b;
  friend constexpr bool operator==(const BroadPhasePair& a, const BroadPhasePair& b) = default;
};

/// A body is in it with bounds that are wider than it is, so that small moves change nothing and cost a
/// comparison. What lies still costs nothing. No allocation once as many bodies and pairs have been there.
/// One thread at a time.
class BroadPhase {
 public:
  /// `thins_crowds`: a body that lies in more than 32 others finds only the nearest 16 of these and of those
  /// about as large as itself, and the nearest 16 of those that are larger. What that costs grows with their
  /// number, not with that of their pairs.
  explicit BroadPhase(bool thins_crowds = false) : m_thins_crowds(thins_crowds) {}

  /// `id` is the caller's, unique; `moves` false for bodies that never do: two of them make no pair. In a
  /// crowd `order` decides between bodies that are equally near, so that nothing depends on ids, which are
  /// used again. Returns the proxy: the number to use below, good until it is removed.
  std::int32_t add(std::uint32_t id, const GridBounds& wide, bool moves, std::uint64_t order = 0);
  void remove(std::int32_t proxy);

  /// The body is now within `tight`. While that lies in the bounds it has, nothing happens; else it gets
  /// `wide`: `tight` and some room for the moves to come. Returns whether it got them.
  bool move(std::int32_t proxy, const GridBounds& tight, const GridBounds& wide);
  /// It gets these bounds.
  void set(std::int32_t proxy, const GridBounds& bounds);
  const GridBounds& bounds(std::int32_t proxy) const { return m_proxies[index(proxy)].bounds; }

  /// All pairs, ordered by (id_a, id_b), good until the next call. Pairs whose bounds ceased to overlap are
  /// gone. Work is done for what was added, removed or given new bounds since the last call.
  std::span<const BroadPhasePair> updatePairs();

  /// visit(id) for every body whose bounds overlap; in no particular order, but always the same one.
  template <class Visit>
  void query(const GridBounds& bounds, Visit&& visit) {
    if (isUntidy()) fileAll();
    const SweptBox box = relative(bounds);
    visitAll(
        bounds, [&](const ImpactTree::Below& below) { return overlaps(below.box, box); },
        [&](std::int32_t proxy) { visit(m_proxies[index(proxy)].id); }, kNone);
  }
  /// Has it found so many in one place that some are left out of its pairs?
  bool isThinned(std::int32_t proxy) const { return m_proxies[index(proxy)].is_thinned; }
  /// The same of any proxy, since it was made.
  bool hasThinned() const { return m_has_thinned; }
  /// How often it has looked whether two bodies make a pair, since it was made.
  std::int64_t looks() const { return m_looks; }

 private:
  struct Proxy {
    std::uint32_t id;
    bool moves;
    bool changed;  // it is in m_changed
    bool is_removed;
    bool is_filed;  // its bounds are within those in the tree; else it is in m_loose, or removed
    bool is_thinned;
    std::uint32_t heaped;  // pairs of a crowd that it is in, while all are looked for at once
    std::uint64_t order;
    GridBounds bounds;
  };
  static std::size_t index(std::int32_t proxy) { return static_cast<std::size_t>(proxy); }
  struct Heaped {
    double square;        // of the distance
    std::uint64_t order;  // of the other one
    BroadPhasePair pair;
  };
  // All that is below a node.
  struct Crowd {
    SweptBox middles;           // around those of their bounds
    Vec2 narrowest, widest;     // of these; beyond any width if one of them never moves
    Vec2 widths;                // all of them together
    std::uint64_t first, last;  // order; of one that has not changed the last is beyond any
  };
  void markChanged(std::int32_t proxy);
  SweptBox relative(const GridBounds& bounds) const;
  float halfOf(const Proxy& proxy) const;
  void fileAll();
  // Are so many not in the tree, or in it with bounds too wide, that another tree costs less?
  bool isUntidy() const {
    return m_loose.size() * m_loose.size() > kScannedPerBody * m_count || kWidenedShare * m_widened > m_count;
  }
  static constexpr std::int32_t kNone = -1;
  // In the tree where it enters(), those beside a proxy first; and what is not in it.
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
  // Of two that move: is the middle of each within the width of the smaller one, are they else about as
  // large, or neither? kOther: one never moves, or crowds are not thinned.
  enum class Kind : std::uint8_t { kOther, kHeaped, kAlike, kUnlike };
  Kind kindOf(const Proxy& a, const Proxy& b) const;
  std::int32_t finderOf(std::int32_t a, std::int32_t b, Kind kind) const;
  bool isBefore(std::int32_t a, std::int32_t b) const;
  bool isSmaller(std::int32_t a, std::int32_t b) const;
  bool isInCrowd(std::int32_t proxy);
  // Of what one finds, those that may be kept.
  struct Nearest {
    std::vector<Heaped> found;
    double farthest = 0;     // of those that may still come …
    std::uint64_t last = 0;  // … and of these the last
    void clear();
    void keep();
  };
  void sortFound();

  // Refitting the tree takes about as long as comparing so many bounds, a body.
  static constexpr std::size_t kScannedPerBody = 8;
  // One of so many may have bounds in the tree that are too wide.
  static constexpr std::size_t kWidenedShare = 4;

  bool m_thins_crowds;
  bool m_has_thinned = false;
  bool m_was_crowded = false;
  std::int64_t m_looks = 0;
  std::vector<Proxy> m_proxies;
  std::vector<std::int32_t> m_free;
  std::vector<std::int32_t> m_changed;
  std::size_t m_count = 0;  // of bodies that are in it
  std::vector<BroadPhasePair> m_pairs, m_found, m_spare;
  Nearest m_heaped, m_larger;
  ImpactTree m_tree;      // of the bounds as they were when all were filed: by proxy, in grid units …
  GridBounds m_origin{};  // … about these
  std::vector<SweptBox> m_boxes;
  std::vector<float> m_halves;  // half of their shorter side; 0 of what never moves
  std::vector<int> m_numbers;
  std::vector<Crowd> m_crowds;        // of nodes of the tree, while pairs of a crowd are found
  std::vector<std::int32_t> m_loose;  // bodies that came, or went elsewhere, since then
  std::size_t m_widened = 0;          // times that bounds in the tree were widened since then
};

}  // namespace naiad::physics
