#include "engine/collision/Grid.h"

#include <algorithm>
#include <cassert>
#include <limits>

#include "engine/collision/GridCoverageMask.h"

namespace df {

namespace {

constexpr int kFirstWidthBits = 4;   // largest box of level 1: 2^4 by 2^2 cells
constexpr int kFirstHeightBits = 2;  // each further level: four times as large on both axes
// Cells are smaller than the largest boxes of their level, so that fewer boxes need the exact test. More
// cells cost little, because a word holds a row of them.
constexpr int kFinerWidthBits = 2;
constexpr int kFinerHeightBits = 1;

constexpr double kWide = 64;  // largest number of cells per character with which spots pay
constexpr double kFew = 512;  // characters; fewer count as this many in that comparison

int bitsFor(Fixed size) {
  return size <= 1 ? 0 : std::bit_width(static_cast<std::uint64_t>(size - 1));
}

}  // namespace

Grid::Grid(const std::vector<FixedVector>& positions, const std::vector<FixedBox>& boxes)
    : m_positions(positions), m_boxes(boxes) {
  for (int n = 1; n < kLevels; ++n) {
    Level& level = m_levels[static_cast<std::size_t>(n)];
    level.x_shift = kFixedBits + kFirstWidthBits - kFinerWidthBits + 2 * (n - 1);
    level.y_shift = kFixedBits + kFirstHeightBits - kFinerHeightBits + 2 * (n - 1);
  }
}

Grid::~Grid() = default;

FixedVector Grid::largest(int level) {
  if (level == 0) return kCharacterBox.size;
  return {Fixed{1} << (kFixedBits + kFirstWidthBits + 2 * (level - 1)),
          Fixed{1} << (kFixedBits + kFirstHeightBits + 2 * (level - 1))};
}

int Grid::levelOf(const FixedBox& box) const {
  if (box == kCharacterBox) return m_characters_apart ? 0 : 1;
  const int too_wide = std::max(0, bitsFor(box.size.x) - kFixedBits - kFirstWidthBits);
  const int too_high = std::max(0, bitsFor(box.size.y) - kFixedBits - kFirstHeightBits);
  return 1 + (std::max(too_wide, too_high) + 1) / 2;
}

void Grid::count(const Record& record, int by) {
  if (record.level > 0) {
    m_boxes_beside += by;
    m_large_boxes += record.area == 0 ? by : 0;
    m_covered_area += by * std::int64_t{record.area};
  }
  if (record.character) {
    m_characters += by;
  } else if (record.level == 1) {
    m_small_boxes += by;
  }
}

// Decides whether characters have a level of their own. This changes so rarely that its cost does not matter.
void Grid::chooseCharacterLevel() {
  const bool apart = m_characters_apart ? m_small_boxes <= 16 || m_characters * 4 >= m_small_boxes
                                        : m_characters > m_small_boxes;
  if (apart == m_characters_apart) return;
  m_characters_apart = apart;
  for (Slot s = 0; s < m_records.size(); ++s) {
    if (contains(s) && m_records[s].character) fileAt(s, apart ? 0 : 1);
  }
}

// Decides whether the boxes of other levels cover so few cells that it pays to mark the covered cells.
void Grid::updateCoverage() {
  const std::int64_t characters = m_levels[0].count;
  if (m_boxes_beside == 0 || characters == 0) return m_p_coverage.reset();
  const bool was_exact = m_p_coverage != nullptr && m_p_coverage->isExact();
  const int most = was_exact ? CoverageMask::kMaxCellsPerCharacter : CoverageMask::kMaxCellsPerCharacter / 2;
  const bool is_exact = m_covered_area <= most * characters;
  if (m_p_coverage == nullptr || is_exact != was_exact) rebuildCoverage(is_exact);
  m_p_coverage->cover(m_large_boxes > 0);
}

void Grid::rebuildCoverage(bool is_exact) {
  m_p_coverage = std::make_unique<CoverageMask>(m_levels[0], is_exact);
  m_p_coverage->cover(m_large_boxes > 0);
  for (Slot s = 0; is_exact && s < m_records.size(); ++s) {
    if (contains(s) && m_records[s].level > 0) cover(s);
  }
}

void Grid::cover(Slot slot) {
  if (!m_p_coverage->isExact()) return;
  if (m_records[slot].area == 0) return m_p_coverage->remove(m_levels[0], slot);
  m_p_coverage->file(m_levels[0], slot, worldBox(slot));
}

int Grid::size() const {
  int sum = 0;
  for (const Level& level : m_levels) sum += level.count;
  return sum;
}

std::size_t Grid::bytes() const {
  std::size_t sum =
      m_records.capacity() * sizeof(Record) + (m_p_coverage != nullptr ? m_p_coverage->bytes() : 0);
  for (const Level& level : m_levels) {
    const std::size_t cell = sizeof(Slot) + (level.spots != nullptr ? sizeof(Spot) : 0);
    sum += level.words.capacity() * (sizeof(std::uint64_t) + 64 * cell);
  }
  return sum;
}

void Grid::file(Slot slot) {
  if (slot >= m_records.size()) m_records.resize(std::max<std::size_t>(slot + 1, m_records.size() * 2));
  fileAt(slot, levelOf(m_boxes[slot]));
  chooseCharacterLevel();
  updateCoverage();
}

void Grid::remove(Slot slot) {
  if (!contains(slot)) return;
  drop(slot);
  chooseCharacterLevel();
  updateCoverage();
}

void Grid::fileAt(Slot slot, int number) {
  Level& level = m_levels[static_cast<std::size_t>(number)];
  Record& record = m_records[slot];
  const bool character = m_boxes[slot] == kCharacterBox;
  const std::uint16_t area = number > 0 ? CoverageMask::areaOf(m_boxes[slot]) : std::uint16_t{0};
  if (record.level == number) {
    count(record, -1);
    record.character = character;
    record.area = area;
    count(record, 1);
    return refile(slot);
  }
  drop(slot);
  if (static_cast<std::size_t>(level.count) >= level.words.size() * kBoxesPerWord) {
    rebuild(number, std::max(kMinWords, level.words.size() * 2));
  }
  ++level.count;
  m_occupied |= 1u << number;
  record.level = static_cast<std::uint8_t>(number);
  record.character = character;
  record.area = area;
  count(record, 1);
  link(slot, level, level.cellOf(anchor(slot, number)));
  if (m_p_coverage != nullptr && number > 0) cover(slot);
}

void Grid::drop(Slot slot) {
  if (!contains(slot)) return;
  const int number = m_records[slot].level;
  Level& level = m_levels[static_cast<std::size_t>(number)];
  unlink(slot, level);
  if (m_p_coverage != nullptr && number > 0) m_p_coverage->remove(m_levels[0], slot);
  count(m_records[slot], -1);
  m_records[slot].level = kNotFiled;
  if (--level.count == 0) m_occupied &= ~(1u << number);
  // Shrinks the arrays if the boxes are fewer than a sixteenth of the number that would make them grow.
  const std::size_t few = level.words.size() * kBoxesPerWord / 16;
  if (level.words.size() > kMinWords && static_cast<std::size_t>(level.count) < few) {
    rebuild(number, level.words.size() / 4);
  }
}

// Sizes the arrays, and makes the part of the world that is mapped without a turn begin at the boxes' area.
void Grid::Level::shape(std::size_t word_count, std::int64_t x0, std::int64_t y0, std::int64_t x1,
                        std::int64_t y1) {
  assert(std::has_single_bit(word_count) && word_count >= 64);
  words.assign(word_count, 0);
  words.shrink_to_fit();
  heads = std::make_unique_for_overwrite<Slot[]>(word_count * 64);
  word_mask = static_cast<std::uint32_t>(word_count - 1);
  base_x = x0 >> 6;
  base_y = y0 >> 6;
  const int bits = std::bit_width(word_count / 64) - 1;  // log2 of the number of blocks
  const auto bitsOf = [](std::int64_t blocks) { return std::bit_width(static_cast<std::uint64_t>(blocks)); };
  const int wide = bitsOf((x1 >> 6) - base_x);
  const int high = bitsOf((y1 >> 6) - base_y);
  // The sides share spare bits equally. They share missing bits equally, too, unless one side needs few.
  x_bits = std::clamp(wide + (bits - wide - high) / 2, 0, bits);
  if (wide + high > bits && wide < bits / 2) x_bits = wide;
  if (wide + high > bits && high < bits / 2) x_bits = bits - high;
  y_bits = bits - x_bits;
  x_mask = (std::int64_t{1} << x_bits) - 1;
}

void Grid::rebuild(int number, std::size_t word_count) {
  Level& level = m_levels[static_cast<std::size_t>(number)];
  std::int64_t x0 = std::numeric_limits<std::int64_t>::max();
  std::int64_t y0 = x0;
  std::int64_t x1 = std::numeric_limits<std::int64_t>::min();
  std::int64_t y1 = x1;
  for (Slot s = 0; s < m_records.size(); ++s) {
    if (m_records[s].level != number) continue;
    const FixedVector corner = anchor(s, number);
    x0 = std::min(x0, corner.x >> level.x_shift);
    x1 = std::max(x1, corner.x >> level.x_shift);
    y0 = std::min(y0, corner.y >> level.y_shift);
    y1 = std::max(y1, corner.y >> level.y_shift);
  }
  if (x0 > x1) x0 = x1 = y0 = y1 = 0;
  level.shape(word_count, x0, y0, x1, y1);
  level.spots = nullptr;
  // Characters scattered so widely that they hardly ever touch do not need spots.
  const double area = static_cast<double>(x1 - x0 + 1) * static_cast<double>(y1 - y0 + 1);
  if (number == 0 && area <= kWide * std::max(kFew, static_cast<double>(level.count))) {
    level.spots = std::make_unique_for_overwrite<Spot[]>(word_count * 64 + kRowOfSpots);
  }
  for (Slot s = 0; s < m_records.size(); ++s) {
    if (m_records[s].level == number) link(s, level, level.cellOf(anchor(s, number)));
  }
  if (number == 0 && m_p_coverage != nullptr) rebuildCoverage(m_p_coverage->isExact());
}

void Grid::touching(const FixedBox& box, Slot self, std::vector<Slot>& out, std::size_t most) const {
  for (std::uint32_t left = m_occupied; left != 0 && out.size() <= most; left &= left - 1) {
    const int number = std::countr_zero(left);
    visitCorners(number, box.corner - largest(number), box.corner + box.size, [&](Slot s) {
      if (s != self && intersects(worldBox(s), box)) out.push_back(s);
      return out.size() <= most;
    });
  }
}

}  // namespace df
