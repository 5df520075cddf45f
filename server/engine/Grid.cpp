#include "Grid.h"

#include <algorithm>
#include <bit>

namespace df {

namespace {

constexpr int kLeastCellBits = kFixedBits + 1;  // two cells

}  // namespace

Grid::Place Grid::placeOf(const FixedBox& box) {
  const auto size = static_cast<std::uint64_t>(std::max(box.size.x, box.size.y));
  const std::uint64_t least = std::uint64_t{1} << kLeastCellBits;
  const int level = size <= least ? 0 : std::bit_width(size - 1) - kLeastCellBits;
  const int shift = kLeastCellBits + level;
  return {level, static_cast<std::int32_t>(box.corner.x >> shift),
          static_cast<std::int32_t>(box.corner.y >> shift)};
}

std::size_t Grid::bucketOf(Place place) const {
  std::uint64_t h = static_cast<std::uint32_t>(place.x) * 0x9E3779B97F4A7C15ull;
  h ^= (static_cast<std::uint32_t>(place.y) + (h >> 29)) * 0xBF58476D1CE4E5B9ull;
  h += static_cast<std::uint64_t>(place.level) * 0x94D049BB133111EBull;
  h ^= h >> 32;
  return static_cast<std::size_t>(h) & (m_buckets.size() - 1);
}

void Grid::link(Slot slot) {
  Record& record = m_records[slot];
  Slot& head = m_buckets[bucketOf({record.level, record.x, record.y})];
  record.previous = kNone;
  record.next = head;
  if (head != kNone) m_records[head].previous = slot;
  head = slot;
}

void Grid::unlink(Slot slot) {
  const Record& record = m_records[slot];
  if (record.previous != kNone) {
    m_records[record.previous].next = record.next;
  } else {
    m_buckets[bucketOf({record.level, record.x, record.y})] = record.next;
  }
  if (record.next != kNone) m_records[record.next].previous = record.previous;
}

void Grid::grow() {
  m_buckets.assign(std::max<std::size_t>(16, m_buckets.size() * 2), kNone);
  for (Slot slot = 0; slot < m_records.size(); ++slot) {
    if (m_records[slot].level >= 0) link(slot);
  }
}

void Grid::put(Slot slot, const FixedBox& box) {
  if (slot >= m_records.size()) m_records.resize(std::max<std::size_t>(slot + 1, m_records.size() * 2));
  const Place place = placeOf(box);
  Record& record = m_records[slot];
  if (place == Place{record.level, record.x, record.y}) return;
  remove(slot);
  if (static_cast<std::size_t>(m_count) >= m_buckets.size()) grow();
  record.level = place.level;
  record.x = place.x;
  record.y = place.y;
  link(slot);
  ++m_count;
  ++m_level_counts[place.level];
  m_levels |= 1u << place.level;
}

void Grid::remove(Slot slot) {
  if (!contains(slot)) return;
  unlink(slot);
  Record& record = m_records[slot];
  if (--m_level_counts[record.level] == 0) m_levels &= ~(1u << record.level);
  record.level = -1;
  --m_count;
}

void Grid::scan(std::uint32_t levels, std::vector<Slot>& out) const {
  for (Slot head : m_buckets) {
    for (Slot slot = head; slot != kNone; slot = m_records[slot].next) {
      if ((levels >> m_records[slot].level) & 1u) out.push_back(slot);
    }
  }
}

void Grid::query(const FixedBox& box, std::vector<Slot>& out) const {
  std::uint32_t to_scan = 0;  // levels on which the box covers more cells than there are boxes
  for (std::uint32_t left = m_levels; left != 0; left &= left - 1) {
    const int level = std::countr_zero(left);
    const int shift = kLeastCellBits + level;
    const Fixed size = Fixed{1} << shift;
    const std::int64_t x0 = (box.corner.x - size) >> shift;
    const std::int64_t y0 = (box.corner.y - size) >> shift;
    const std::int64_t x1 = (box.corner.x + box.size.x) >> shift;
    const std::int64_t y1 = (box.corner.y + box.size.y) >> shift;
    if ((x1 - x0 + 1) * (y1 - y0 + 1) > std::max<std::int64_t>(16, m_count)) {
      to_scan |= 1u << level;
      continue;
    }
    for (std::int64_t y = y0; y <= y1; ++y) {
      for (std::int64_t x = x0; x <= x1; ++x) {
        const Place place{level, static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)};
        for (Slot slot = m_buckets[bucketOf(place)]; slot != kNone; slot = m_records[slot].next) {
          const Record& record = m_records[slot];
          if (place == Place{record.level, record.x, record.y}) out.push_back(slot);
        }
      }
    }
  }
  if (to_scan != 0) scan(to_scan, out);
}

}  // namespace df
