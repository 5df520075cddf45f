#include "physics/body/BlockContacts.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace naiad::physics {

namespace {

constexpr double kLevel = 0.01;    // of a shape's thickness: points so near to the lowest one touch, too
constexpr double kOverlap = 1e-6;  // metric cells: an Object must be touched over this length
constexpr int kOrphanTicks = 3;    // bodies may press on the new block a tick later

// Returns the components of a vector across and along a face.
double outward(int side, Vec2 v) {
  const double across = side < 2 ? v.x : v.y;
  return side % 2 == 0 ? -across : across;
}
double along(int side, Vec2 v) {
  return side < 2 ? v.y : v.x;
}

struct Ends {
  Vec2 low, high;
};
Ends endsOf(const Metric& metric, const BlockContacts::View& view, const BoxArea& area, const Place& origin) {
  const FixedBox box = area.box();
  const Vec2 low = view.members.empty()
                       ? metric.placeOf(box.corner) - origin
                       : (view.base - origin) + metric.fromCells(Vector::fromFixed(box.corner));
  return {low, low + metric.fromCells(Vector::fromFixed(box.size))};
}
double lineOf(int side, const Ends& ends) {
  const Vec2 corner = side % 2 == 0 ? ends.low : ends.high;
  return side < 2 ? corner.x : corner.y;
}

// Returns the distance of the lowest point of the shapes from their origin, against a face's normal.
double depthOf(std::span<const ConvexShape> shapes, Rotation rotation, int side) {
  double depth = -kMaxShapeExtent;
  for (const ConvexShape& shape : shapes) {
    for (std::int32_t i = 0; i < shape.count; ++i) {
      const Vec2 v = rotation * shape.vertices[static_cast<std::size_t>(i)];
      depth = std::max(depth, shape.radius - outward(side, v));
    }
  }
  return depth;
}

}  // namespace

void BlockContacts::add(const BodyContact& contact, int body, int block) {
  const auto isIts = [&](const Touch& touch) {
    return touch.body == body && touch.block == block && touch.contact.first == contact.first &&
           touch.orphaned == 0;
  };
  const auto at = std::find_if(m_touches.rbegin(), m_touches.rend(), isIts);
  const bool is_known = at != m_touches.rend() && at->end > 1;
  if (!contact.is_begin) {
    if (is_known) at->end = contact.time;
    return;
  }
  if (is_known) {  // the solver has found it anew
    at->contact = contact;
    at->is_new = true;
    at->begin = contact.time;
    return;
  }
  Touch touch;
  touch.contact = contact;
  touch.body = body, touch.block = block;
  touch.begin = contact.time;
  m_touches.push_back(std::move(touch));
}

// Finds the parts of a block whose faces have a part of this stretch.
void BlockContacts::findParts(const WorldStore& store, const Metric& metric, const View& view, int side,
                              const Place& origin, Stretch stretch) {
  m_found.clear();
  const BoxArea& whole = view.p_shape->whole;
  const auto add = [&](const Part& part, const BoxArea& area) {
    if (!BoxUnion::isBehind(area, side, whole.line(side))) return;
    const Ends its = endsOf(metric, view, area, origin);
    m_found.push_back({part, {along(side, its.low), along(side, its.high)}});
  };
  for (const Member& member : view.members) add({member.key, member.order, true}, member.area);
  if (!view.members.empty()) return;
  constexpr double kRoom = 0.1;  // metric cells, more than a gap between boxes that touch
  const double line = lineOf(side, endsOf(metric, view, whole, origin));
  const double middle = 0.5 * (stretch.low + stretch.high), half = 0.5 * (stretch.high - stretch.low) + kRoom;
  const bool is_upright = side < 2;
  const Place centre = origin + (is_upright ? Vec2{line, middle} : Vec2{middle, line});
  m_keys.clear();
  store.touching(regionOf(metric, centre, is_upright ? Vec2{0, half} : Vec2{half, 0}), WorldStore::kNoSlot,
                 m_keys);
  for (const ObjectKey key : m_keys) {
    if (!BodyObstacles::isObstacle(store, key)) continue;
    add({key, store.order(key.slot), false}, BoxArea::of(store.worldBox(key.slot, store.position(key.slot))));
  }
}

void BlockContacts::change(const Touch& touch, const Part& part, double time, double impulse, bool is_begin) {
  BodyContact contact = touch.contact;
  contact.second = part.key, contact.second_order = part.order;
  if (part.is_body && part.order < contact.first_order) {  // the older body comes first
    std::swap(contact.first, contact.second);
    std::swap(contact.first_order, contact.second_order);
  }
  contact.time = std::clamp(time, 0.0, 1.0);
  contact.impulse = impulse;
  contact.is_begin = is_begin;
  m_changes.push_back(contact);
}

void BlockContacts::settle(const WorldStore& store, const Metric& metric, const View& view,
                           const Mover& mover, Touch& touch) {
  if (!touch.is_new) touch.begin = 0;
  if (mover.key != touch.contact.first || mover.shapes.empty()) {
    touch.body = -1;  // another solver moves it, and finds its contacts
    return;
  }
  if (view.p_shape == nullptr && touch.orphaned == 0) touch.orphaned = 1;
  if (touch.orphaned > 0) return;
  const Pose& end = mover.end;
  const bool has_moved = touch.is_new || touch.end <= 1 ||
                         !(touch.pose.place == end.place && touch.pose.rotation == end.rotation);
  if (!has_moved) return;
  const Ends ends = endsOf(metric, view, view.p_shape->area, end.place);
  int side = 0;
  double best = -1e300;
  for (int i = 0; i < kBoxSides; ++i) {
    const double gap =
        -depthOf(mover.shapes, end.rotation, i) - outward(i, i % 2 == 0 ? ends.low : ends.high);
    if (gap > best) best = gap, side = i;
  }
  const Stretch face = {along(side, ends.low), along(side, ends.high)};
  const auto stretchAt = [&](const Pose& pose) {
    const double least = depthOf(mover.shapes, pose.rotation, side),
                 off = along(side, pose.place - end.place);
    Stretch all = {1e300, -1e300};
    for (const ConvexShape& shape : mover.shapes) {
      const double level = least - kLevel * thicknessOf(shape);
      for (std::int32_t i = 0; i < shape.count; ++i) {
        const Vec2 v = pose.rotation * shape.vertices[static_cast<std::size_t>(i)];
        if (shape.radius - outward(side, v) < level) continue;
        all.low = std::min(all.low, off + along(side, v)),
        all.high = std::max(all.high, off + along(side, v));
      }
    }
    return Stretch{std::clamp(all.low, face.low, face.high), std::clamp(all.high, face.low, face.high)};
  };
  const Stretch now = stretchAt(end);
  Stretch before = now;
  if (touch.is_new) {
    const Vec2 moved = touch.begin * mover.velocity + (1 - touch.begin) * view.velocity;
    before = stretchAt({mover.start.place + moved, mover.start.rotation});
  } else if (touch.side == side) {
    const double off = along(side, (touch.pose.place - end.place) + view.velocity);
    before = {touch.stretch.low + off, touch.stretch.high + off};
  }
  const Stretch path = {std::min(before.low, now.low), std::max(before.high, now.high)};
  findParts(store, metric, view, side, end.place, path);
  // A point touches the Object that contains it, or the nearest one if it is above a gap.
  const auto nearest = [this](Stretch at) {
    const double point = 0.5 * (at.low + at.high);
    const Found* p_best = nullptr;
    double least = 1e300;
    for (const Found& found : m_found) {
      const double off = std::max({found.stretch.low - point, point - found.stretch.high, 0.0});
      if (off < least) least = off, p_best = &found;
    }
    return p_best;
  };
  const Found *p_now = nearest(now), *p_before = nearest(before);
  const auto isUnder = [&](const Found& found, Stretch at, const Found* p_nearest) {
    return &found == p_nearest ||
           std::min(found.stretch.high, at.high) - std::max(found.stretch.low, at.low) > kOverlap;
  };
  const double from = touch.is_new ? touch.begin : 0, until = std::min(touch.end, 1.0);
  const bool is_up = now.low + now.high >= before.low + before.high;
  const auto timeAt = [&](double edge_before, double edge_now, double place) {
    const double distance = edge_now - edge_before;
    return distance == 0 ? from
                         : from + (until - from) * std::clamp((place - edge_before) / distance, 0.0, 1.0);
  };
  const auto first_ones = std::count_if(m_found.begin(), m_found.end(),
                                        [&](const Found& found) { return isUnder(found, before, p_before); });
  std::vector<Part> parts;
  for (const Found& found : m_found) {
    const bool is_first = isUnder(found, before, p_before), is_last = isUnder(found, now, p_now);
    if (!is_first && !is_last && !isUnder(found, path, nullptr)) continue;
    const bool is_known = std::any_of(touch.parts.begin(), touch.parts.end(),
                                      [&](const Part& part) { return part.key == found.part.key; });
    if (!is_known || touch.is_new) {
      const double time = is_first ? from
                          : is_up  ? timeAt(before.high, now.high, found.stretch.low)
                                   : timeAt(before.low, now.low, found.stretch.high);
      const double impulse =
          touch.is_new && is_first ? touch.contact.impulse / static_cast<double>(first_ones) : 0;
      change(touch, found.part, time, impulse, true);
    }
    if (is_last && touch.end > 1) {
      parts.push_back(found.part);
    } else {
      const double time = touch.end <= 1 && is_last ? touch.end
                          : is_up                   ? timeAt(before.low, now.low, found.stretch.high)
                                                    : timeAt(before.high, now.high, found.stretch.low);
      change(touch, found.part, time, 0, false);
    }
  }
  for (const Part& part : touch.parts) {  // those that are not even near the path
    const auto isFound = [&](const Found& found) {
      return found.part.key == part.key &&
             (isUnder(found, path, nullptr) || &found == p_now || &found == p_before);
    };
    if (std::none_of(m_found.begin(), m_found.end(), isFound)) change(touch, part, from, 0, false);
  }
  touch.parts = std::move(parts);
  touch.side = side, touch.stretch = now, touch.pose = end;
  touch.is_new = false;
}

// True if another contact of the body, which lasts and began before this time, has this Object.
bool BlockContacts::isHeld(ObjectKey body, ObjectKey part, double time) const {
  return std::any_of(m_touches.begin(), m_touches.end(), [&](const Touch& touch) {
    return touch.body >= 0 && touch.contact.first == body && touch.orphaned == 0 && touch.end > 1 &&
           touch.begin <= time &&
           std::any_of(touch.parts.begin(), touch.parts.end(),
                       [part](const Part& its) { return its.key == part; });
  });
}

void BlockContacts::publish(BodyContacts& contacts) {
  for (Touch& touch : m_touches) {
    if (touch.orphaned == 0 || touch.body < 0 || touch.orphaned++ <= kOrphanTicks) continue;
    for (const Part& part : touch.parts) change(touch, part, 0, 0, false);
    touch.body = -1;
  }
  for (const BodyContact& contact : m_changes) {
    if (contact.is_begin || !(isHeld(contact.first, contact.second, contact.time) ||
                              isHeld(contact.second, contact.first, contact.time)))
      contacts.add(contact);
  }
  m_changes.clear();
  std::erase_if(m_touches, [](const Touch& touch) { return touch.body < 0 || touch.end <= 1; });
}

}  // namespace naiad::physics
