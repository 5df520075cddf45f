#include "physics/body/BoxUnion.h"

#include <algorithm>
#include <limits>

#include "physics/body/BodyObstacles.h"

namespace naiad::physics {

namespace {

constexpr Fixed kMinDepth = df::kFixedOne >> 20;  // a box must reach so far behind a face to be a part of it
constexpr Fixed kReachAtOnce = 16 * df::kFixedOne;  // part of a face that is searched by one query
constexpr std::size_t kMaxBoxes = 1024;             // a block of more boxes does not get deeper

Fixed inward(int side, Fixed line, Fixed depth) {
  return side % 2 == 0 ? line + depth : line - depth;
}
// The depths of a box's near and far face behind a line.
Fixed nearOf(const BoxArea& area, int side, Fixed line) {
  return side % 2 == 0 ? area.low[BoxArea::axisOf(side)] - line : line - area.high[BoxArea::axisOf(side)];
}
Fixed farOf(const BoxArea& area, int side, Fixed line) {
  return side % 2 == 0 ? area.high[BoxArea::axisOf(side)] - line : line - area.low[BoxArea::axisOf(side)];
}

// True if the area is in front of a line, and not farther from it than a gap.
bool isBeside(const BoxArea& area, int side, Fixed line) {
  return farOf(area, side, line) >= -BoxUnion::kGap && nearOf(area, side, line) < -kMinDepth;
}

BoxArea widened(BoxArea area, Fixed by) {
  for (const std::size_t i : {0u, 1u}) area.low[i] -= by, area.high[i] += by;
  return area;
}

}  // namespace

bool BoxUnion::isBehind(const BoxArea& area, int side, Fixed line) {
  return nearOf(area, side, line) <= kSame && farOf(area, side, line) > kMinDepth;
}

bool BoxUnion::areTouching(const BoxArea& a, const BoxArea& b) {
  return a.low[0] <= b.high[0] + kGap && b.low[0] <= a.high[0] + kGap && a.low[1] <= b.high[1] + kGap &&
         b.low[1] <= a.high[1] + kGap;
}

void BoxUnion::find(const BoxArea& area) {
  m_found.clear();
  m_found_keys.clear();
  if (m_p_store == nullptr) {
    const FixedBox box = area.box();
    for (const BoxArea& listed : m_list) {
      if (intersects(listed.box(), box)) m_found.push_back(listed);
    }
    return;
  }
  m_keys.clear();
  m_p_store->touching(area.box(), WorldStore::kNoSlot, m_keys);
  for (const ObjectKey key : m_keys) {
    if (!BodyObstacles::isObstacle(*m_p_store, key)) continue;
    m_found.push_back(BoxArea::of(m_p_store->worldBox(key.slot, m_p_store->position(key.slot))));
    m_found_keys.push_back(key);
  }
}

std::size_t BoxUnion::look(const BoxArea& area) {
  find(widened(area, kGap));
  return m_found.size();
}

void BoxUnion::listBeside(const BoxArea& area, int side, std::vector<Neighbour>& all) const {
  for (std::size_t i = 0; i < m_found_keys.size(); ++i) {
    if (isBeside(m_found[i], side, area.line(side))) all.push_back({m_found_keys[i], m_found[i]});
  }
}

void BoxUnion::sortAlong(std::size_t axis) {
  std::sort(m_found.begin(), m_found.end(),
            [axis](const BoxArea& a, const BoxArea& b) { return a.low[axis] < b.low[axis]; });
}

// Returns how far boxes follow each other just inside a face, from a point of it up to a limit or beyond.
Fixed BoxUnion::endOfFace(int side, Fixed line, Fixed from, Fixed limit, bool& is_cut) {
  const std::size_t axis = BoxArea::axisOf(side), along = BoxArea::alongOf(side);
  const bool is_up = limit > from;
  Fixed end = from;
  for (;;) {
    BoxArea area;
    area.low[axis] = line - kSame, area.high[axis] = line + kSame;
    area.low[along] = is_up ? end - kSame : end - kReachAtOnce,
    area.high[along] = is_up ? end + kReachAtOnce : end + kSame;
    find(widened(area, kGap));
    std::sort(m_found.begin(), m_found.end(), [&](const BoxArea& a, const BoxArea& b) {
      return is_up ? a.low[along] < b.low[along] : a.high[along] > b.high[along];
    });
    const Fixed before = end;
    for (const BoxArea& box : m_found) {
      if (!isBehind(box, side, line)) continue;
      if (is_up ? box.low[along] > end + kGap : box.high[along] < end - kGap) break;
      end = is_up ? std::max(end, box.high[along]) : std::min(end, box.low[along]);
    }
    if (end == before) return end;
    is_cut = is_up ? end >= limit : end <= limit;
    if (is_cut) return end;
  }
}

// Returns how deep the boxes behind a part of a face are without a gap.
Fixed BoxUnion::depthOf(int side, Fixed line, Fixed from, Fixed to) {
  const std::size_t axis = BoxArea::axisOf(side), along = BoxArea::alongOf(side);
  Fixed depth = 0;
  for (std::size_t seen = 0; seen < kMaxBoxes; seen += m_found.size()) {
    BoxArea area;
    area.low[along] = from, area.high[along] = to;
    area.low[axis] = area.high[axis] = inward(side, line, depth);
    find(widened(area, depth == 0 ? kSame : kGap));
    sortAlong(along);
    Fixed covered = from, next = std::numeric_limits<Fixed>::max();
    for (const BoxArea& box : m_found) {
      const Fixed far = farOf(box, side, line);
      if (nearOf(box, side, line) > depth + (depth == 0 ? kSame : kGap) || far <= depth + kMinDepth) continue;
      if (box.low[along] > covered + (covered == from ? kSame : kGap) || covered >= to - kSame) break;
      if (box.high[along] <= covered) continue;
      covered = box.high[along];
      next = std::min(next, far);
    }
    if (covered < to - kSame) break;
    depth = next;
  }
  return depth;
}

// True if boxes outside a block continue one of its faces.
bool BoxUnion::continues(const BoxArea& whole, int side, bool is_up) const {
  const std::size_t along = BoxArea::alongOf(side);
  return std::any_of(m_found.begin(), m_found.end(), [&](const BoxArea& box) {
    if (!isBehind(box, side, whole.line(side))) return false;
    return is_up
               ? box.low[along] <= whole.high[along] + kGap && box.high[along] > whole.high[along] + kMinDepth
               : box.high[along] >= whole.low[along] - kGap && box.low[along] < whole.low[along] - kMinDepth;
  });
}

// Returns the length of a face that is covered by boxes from outside, from one of its ends on.
Fixed BoxUnion::coveredFrom(const BoxArea& area, int side, bool is_upper_end) const {
  const std::size_t along = BoxArea::alongOf(side);
  const Fixed line = area.line(side), size = area.high[along] - area.low[along];
  m_covers.clear();
  for (const BoxArea& box : m_found) {
    if (!isBeside(box, side, line)) continue;
    // The search begins at the end.
    const Fixed begin = is_upper_end ? area.high[along] - box.high[along] : box.low[along] - area.low[along];
    m_covers.emplace_back(begin, begin + (box.high[along] - box.low[along]));
  }
  std::sort(m_covers.begin(), m_covers.end());
  Fixed covered = 0;
  for (const auto& [begin, end] : m_covers) {
    if (begin > covered + (covered == 0 ? kSame : kGap)) break;
    covered = std::max(covered, end);
  }
  return std::min(covered, size);
}

bool BoxUnion::isHidden(const BoxArea& area, int side) const {
  const std::size_t along = BoxArea::alongOf(side);
  return coveredFrom(area, side, false) >= area.high[along] - area.low[along] - kSame;
}

// Returns a point just outside of the part of a side that is not hidden, by one of the part's ends.
std::array<Fixed, 2> BoxUnion::openPoint(const BoxArea& area, int side, bool is_upper_end) const {
  const std::size_t axis = BoxArea::axisOf(side), along = BoxArea::alongOf(side);
  const Fixed covered = coveredFrom(area, side, is_upper_end) + kGap / 2;
  std::array<Fixed, 2> point;
  point[along] = is_upper_end ? area.high[along] - covered : area.low[along] + covered;
  point[axis] = inward(side, area.line(side), -kGap / 2);
  return point;
}

// Withdraws the faces that are only parts of other blocks' faces into the union. Otherwise a body that slides
// over the other face would hit this block's corner. Upright faces stay half as deep in the union as they
// can, so that a body that goes down stairs is far from the corner; others are withdrawn to the inner corner.
void BoxUnion::trim(Block& block, int own, std::array<bool, 2> is_cut, bool may_overlap) {
  const BoxArea& whole = block.whole;
  look(whole);
  std::array<std::array<bool, 2>, kBoxSides> goes_on = {};  // by side, at its lower and upper end
  for (int side = 0; side < kBoxSides; ++side) {
    const auto at = static_cast<std::size_t>(side);
    if (side != own) goes_on[at] = {continues(whole, side, false), continues(whole, side, true)};
    if (side / 2 == own / 2) {  // a face that is cut continues, but its end is far from all bodies
      for (const std::size_t end : {0u, 1u}) goes_on[at][end] = goes_on[at][end] && !is_cut[end];
    }
    block.is_complete[at] = !goes_on[at][0] && !goes_on[at][1];
  }
  block.area = whole;
  std::array<Fixed, kBoxSides> outer = {};
  const auto withdraw = [&](int side, Fixed by) {
    (side % 2 == 0 ? block.area.low : block.area.high)[BoxArea::axisOf(side)] += side % 2 == 0 ? by : -by;
  };
  for (int side = 0; side < kBoxSides; ++side) {
    const auto at = static_cast<std::size_t>(side);
    if (block.is_complete[at]) continue;
    const std::size_t axis = BoxArea::axisOf(side);
    const Fixed size = whole.high[axis] - whole.low[axis];
    Fixed most = size, least = size;
    bool is_free = true;
    for (const bool is_up : {false, true}) {  // the two faces adjacent to this one
      const int beside = static_cast<int>(2 * BoxArea::alongOf(side)) + (is_up ? 1 : 0);
      const Fixed covered = coveredFrom(whole, beside, side % 2 == 1);
      if (goes_on[at][is_up ? 1 : 0]) least = std::min(least, covered);
      if (!block.is_complete[static_cast<std::size_t>(beside)]) continue;
      most = std::min(most, covered);
      is_free = false;
    }
    if (is_free) most = size / 2;
    if (most > kSame) {
      withdraw(side, axis == 0 ? most / 2 : most);
    } else if (axis == 1) {
      outer[at] = least;
    }
  }
  // One of two faces at the outer corner of an L must keep an edge; floors and ceilings get none. This block
  // still reaches into the one that has the whole floor.
  for (const int side : {kTopSide, kBottomSide}) {
    const Fixed covered = outer[static_cast<std::size_t>(side)], line = whole.line(side);
    if (covered == 0 || !may_overlap) continue;
    bool is_long = false;
    Block floor;
    floor.whole.low[0] = endOfFace(side, line, whole.low[0], whole.low[0] - kMaxReach, is_long);
    floor.whole.high[0] = endOfFace(side, line, whole.high[0], whole.high[0] + kMaxReach, is_long);
    const Fixed far = inward(side, line, depthOf(side, line, floor.whole.low[0], floor.whole.high[0]));
    floor.whole.low[1] = std::min(line, far), floor.whole.high[1] = std::max(line, far);
    trim(floor, side, {}, false);
    withdraw(side, std::min(covered, floor.area.high[1] - floor.area.low[1]) / 4);
  }
  for (const std::size_t axis : {0u, 1u}) {  // in a tangle of overlapping boxes, two faces may cross
    if (block.area.low[axis] < block.area.high[axis]) continue;
    block.area.low[axis] = whole.low[axis], block.area.high[axis] = whole.high[axis];
  }
}

BoxUnion::Block BoxUnion::blockAt(const BoxArea& area, int side, Fixed from, Fixed to) {
  const std::size_t axis = BoxArea::axisOf(side), along = BoxArea::alongOf(side);
  const Fixed line = area.line(side);
  Block block;
  bool is_cut_low = false, is_cut_high = false;
  block.whole.low[along] = endOfFace(side, line, area.low[along], from - kMaxReach, is_cut_low);
  block.whole.high[along] = endOfFace(side, line, area.high[along], to + kMaxReach, is_cut_high);
  block.is_cut = is_cut_low || is_cut_high;
  const Fixed depth = depthOf(side, line, block.whole.low[along], block.whole.high[along]);
  if (depth == 0) {  // the box is too thin to be a part of anything
    block.whole = block.area = area;
    block.is_complete = {true, true, true, true};
    return block;
  }
  const Fixed far = inward(side, line, depth);
  block.whole.low[axis] = std::min(line, far), block.whole.high[axis] = std::max(line, far);
  trim(block, side, {is_cut_low, is_cut_high}, true);
  return block;
}

}  // namespace naiad::physics
