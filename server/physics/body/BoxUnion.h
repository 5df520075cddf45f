// The union of HARD Objects' boxes that touch: floors, walls and stairs made of tiles.
//
// A body that slides over a row of boxes must not notice where one ends and the next one begins. So solvers
// get blocks instead of boxes: a block lies within the union and has one of its faces in full length, from
// one corner of the union's border to the next. It depends on the union only, not on how boxes make it up.
#pragma once

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "engine/world/WorldStore.h"
#include "physics/body/WorldNames.h"

namespace naiad::physics {

/// A side of a box. `side / 2` is the axis of its normal; odd sides are those at the higher coordinate.
enum BoxSide : int { kLeftSide, kRightSide, kTopSide, kBottomSide, kBoxSides };

/// A box by its lower and upper coordinates.
struct BoxArea {
  std::array<Fixed, 2> low = {}, high = {};

  friend constexpr bool operator==(const BoxArea& a, const BoxArea& b) = default;
  Fixed line(int side) const { return side % 2 == 0 ? low[axisOf(side)] : high[axisOf(side)]; }
  FixedBox box() const { return {{low[0], low[1]}, {high[0] - low[0], high[1] - low[1]}}; }
  static BoxArea of(const FixedBox& box) {
    const FixedVector end = box.corner + box.size;
    return {{box.corner.x, box.corner.y}, {end.x, end.y}};
  }
  static constexpr std::size_t axisOf(int side) { return static_cast<std::size_t>(side / 2); }
  static constexpr std::size_t alongOf(int side) { return 1 - axisOf(side); }
};

class BoxUnion {
 public:
  /// Boxes with at most this gap between them touch.
  static constexpr Fixed kGap = df::kFixedOne / 64;
  /// Faces whose positions differ by at most this much, by rounding, are collinear.
  static constexpr Fixed kSame = 4;

  static constexpr Fixed kMaxReach = 128 * df::kFixedOne;

  struct Block {
    BoxArea whole;  ///< covered by boxes
    BoxArea area;   ///< given to solvers: `whole` without ends that would lie flush with another block's face
    std::array<bool, kBoxSides> is_complete = {};  ///< true if the face of a side has its full length
    bool is_cut = false;                           ///< true if its own face is longer, but the search ended
  };

  /// Sets the boxes that are used from now on: those of the store's obstacles, or those of a list.
  void setStore(const WorldStore& store) { m_p_store = &store; }
  void setList(std::span<const BoxArea> boxes) { m_p_store = nullptr, m_list = boxes; }
  /// Finds the boxes that touch the area, for isHidden(). Returns their number.
  std::size_t look(const BoxArea& area);
  /// Appends the boxes found by look() that lie outside of the area, at this side.
  struct Neighbour {
    ObjectKey key;
    BoxArea area;
  };
  void listBeside(const BoxArea& area, int side, std::vector<Neighbour>& all) const;
  /// True if this side of an area, for which look() was called, is covered by other boxes from outside.
  bool isHidden(const BoxArea& area, int side) const;
  /// Returns a point just outside of a side that is not hidden, where no box is.
  std::array<Fixed, 2> openPoint(const BoxArea& area, int side, bool is_upper_end) const;
  /// Returns the block that has the complete face of which this side of a box is a part. The search along the
  /// face ends kMaxReach beyond `from` … `to`, which contains the box.
  Block blockAt(const BoxArea& area, int side, Fixed from, Fixed to);

  /// True if the area has something just inside the face on this line.
  static bool isBehind(const BoxArea& area, int side, Fixed line);
  /// True if the areas are not farther apart than kGap.
  static bool areTouching(const BoxArea& a, const BoxArea& b);

 private:
  void find(const BoxArea& area);
  void sortAlong(std::size_t axis);
  Fixed endOfFace(int side, Fixed line, Fixed from, Fixed limit, bool& is_cut);
  Fixed depthOf(int side, Fixed line, Fixed from, Fixed to);
  bool continues(const BoxArea& whole, int side, bool is_up) const;
  Fixed coveredFrom(const BoxArea& area, int side, bool is_upper_end) const;
  void trim(Block& block, int side, std::array<bool, 2> is_cut, bool may_overlap);

  const WorldStore* m_p_store = nullptr;
  std::span<const BoxArea> m_list;
  std::vector<ObjectKey> m_keys;
  std::vector<BoxArea> m_found;
  std::vector<ObjectKey> m_found_keys;  // of m_found, until it is sorted; none for a list
  mutable std::vector<std::pair<Fixed, Fixed>> m_covers;
};

}  // namespace naiad::physics
