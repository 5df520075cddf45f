#include "Grid.h"

#include <algorithm>
#include <limits>

namespace df {

namespace {

constexpr int kFirstWidthBits = 4;   // of level 1: boxes up to 16 by 4
constexpr int kFirstHeightBits = 2;  // each further level takes four times as much on both axes

int bitsFor(Fixed size) {
  return size <= 1 ? 0 : std::bit_width(static_cast<std::uint64_t>(size - 1));
}

}  // namespace

Grid::Grid(const std::vector<FixedVector>& positions, const std::vector<FixedBox>& boxes)
    : m_positions(positions), m_boxes(boxes) {
  for (int n = 1; n < kLevels; ++n) {
    Level& level = m_levels[static_cast<std::size_t>(n)];
    level.x_shift = kFixedBits + kFirstWidthBits + 2 * (n - 1);
    level.y_shift = kFixedBits + kFirstHeightBits + 2 * (n - 1);
  }
}

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
  if (record.character) {
    m_characters += by;
  } else if (record.level == 1) {
    m_small_boxes += by;
  }
}

// Do characters deserve a level of their own? The answer changes so rarely that moving them costs nothing.
void Grid::weigh() {
  const bool apart = m_characters_apart ? m_small_boxes <= 16 || m_characters * 4 >= m_small_boxes
                                        : m_characters > m_small_boxes;
  if (apart == m_characters_apart) return;
  m_characters_apart = apart;
  for (Slot s = 0; s < m_records.size(); ++s) {
    if (m_records[s].level >= 0 && m_records[s].character) fileAt(s, apart ? 0 : 1);
  }
}

int Grid::size() const {
  int sum = 0;
  for (const Level& level : m_levels) sum += level.count;
  return sum;
}

std::size_t Grid::bytes() const {
  std::size_t sum = m_records.capacity() * sizeof(Record);
  for (const Level& level : m_levels) {
    sum += level.words.capacity() * (sizeof(std::uint64_t) + 64 * sizeof(Slot));
  }
  return sum;
}

void Grid::file(Slot slot) {
  if (slot >= m_records.size()) m_records.resize(std::max<std::size_t>(slot + 1, m_records.size() * 2));
  fileAt(slot, levelOf(m_boxes[slot]));
  weigh();
}

void Grid::remove(Slot slot) {
  if (!contains(slot)) return;
  drop(slot);
  weigh();
}

void Grid::fileAt(Slot slot, int number) {
  Level& level = m_levels[static_cast<std::size_t>(number)];
  Record& record = m_records[slot];
  const bool character = m_boxes[slot] == kCharacterBox;
  if (record.level == number) {
    count(record, -1);
    record.character = character;
    count(record, 1);
    return refile(slot, level);
  }
  drop(slot);
  if (static_cast<std::size_t>(level.count) >= level.words.size() * kBoxesPerWord) {
    rebuild(number, std::max(kLeastWords, level.words.size() * 2));
  }
  ++level.count;
  m_occupied |= 1u << number;
  record.level = static_cast<std::int16_t>(number);
  record.character = character;
  count(record, 1);
  link(slot, level, level.cellOf(anchor(slot, number)));
}

void Grid::drop(Slot slot) {
  if (!contains(slot)) return;
  const int number = m_records[slot].level;
  Level& level = m_levels[static_cast<std::size_t>(number)];
  unlink(slot, level);
  count(m_records[slot], -1);
  m_records[slot].level = -1;
  if (--level.count == 0) m_occupied &= ~(1u << number);
  // A sixteenth of what would have it grow beyond this size: give memory back.
  const std::size_t few = level.words.size() * kBoxesPerWord / 16;
  if (level.words.size() > kLeastWords && static_cast<std::size_t>(level.count) < few) {
    rebuild(number, level.words.size() / 4);
  }
}

// The torus is unrolled over where the boxes are now.
void Grid::Level::shape(std::size_t word_count, std::int64_t x0, std::int64_t y0, std::int64_t x1,
                        std::int64_t y1) {
  words.assign(word_count, 0);
  words.shrink_to_fit();
  heads = std::make_unique_for_overwrite<Slot[]>(word_count * 64);
  word_mask = static_cast<std::uint32_t>(word_count - 1);
  base_x = x0 >> 6;
  base_y = y0 >> 6;
  const int bits = std::bit_width(word_count / 64) - 1;  // blocks, as a power of two
  const auto bitsOf = [](std::int64_t blocks) { return std::bit_width(static_cast<std::uint64_t>(blocks)); };
  const int wide = bitsOf((x1 >> 6) - base_x);
  const int high = bitsOf((y1 >> 6) - base_y);
  // What is to spare is shared between the sides; so is what is missing, unless one side needs little.
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
  for (Slot s = 0; s < m_records.size(); ++s) {
    if (m_records[s].level == number) link(s, level, level.cellOf(anchor(s, number)));
  }
}

void Grid::touching(const FixedBox& box, Slot self, std::vector<Slot>& out) const {
  for (std::uint32_t left = m_occupied; left != 0; left &= left - 1) {
    const int number = std::countr_zero(left);
    visitCorners(number, box.corner - largest(number), box.corner + box.size, [&](Slot s) {
      if (s != self && intersects(worldBox(s), box)) out.push_back(s);
    });
  }
}

// Where the nine cells lie in more than one block.
bool Grid::Steps::lookAround(Slot s, FixedVector where) {
  --m_nine_cells;
  ++m_grid.m_paths.far_cells;
  const FixedVector corner = where + kCharacterBox.corner;
  const FixedVector one{kFixedOne, kFixedOne};
  m_grid.visitCorners(0, corner - one, corner + one, [&](Slot t) {
    if (t != s && touches(t, where - one)) found(t);
  });
  if (m_others != 0) lookAtOthers(s, where);
  return m_count == 0;
}

void Grid::Steps::lookAtOthers(Slot s, FixedVector where) {
  const FixedBox box = translate(kCharacterBox, where);
  for (std::uint32_t left = m_others; left != 0; left &= left - 1) visit(std::countr_zero(left), s, box);
}

// The window is no more than four cells wide and high for a box of its level; as for characters, the numbers
// of its cells follow from the box's own while it stays in one block.
bool Grid::Steps::isBoxFree(Slot s, const Record& own, FixedVector where) {
  m_count = 0;
  m_lifted = m_plain = false;
  const Level& level = m_grid.m_levels[static_cast<std::size_t>(own.level)];
  const FixedBox box = translate(m_grid.m_boxes[s], where);
  const FixedVector low = box.corner - FixedVector{Fixed{1} << level.x_shift, Fixed{1} << level.y_shift};
  const FixedVector high = box.corner + box.size;
  const FixedVector from = m_p_positions[s] + m_grid.m_boxes[s].corner;
  const std::int64_t own_x = from.x >> level.x_shift;
  const std::int64_t own_y = from.y >> level.y_shift;
  const std::int64_t x0 = low.x >> level.x_shift;
  const std::int64_t y0 = low.y >> level.y_shift;
  const std::int64_t x1 = high.x >> level.x_shift;
  const std::int64_t y1 = high.y >> level.y_shift;
  const bool same_block =
      (((x0 ^ own_x) | (x1 ^ own_x) | (y0 ^ own_y) | (y1 ^ own_y)) & ~std::int64_t{63}) == 0;
  std::uint32_t others = m_grid.m_occupied;
  ++(same_block ? m_grid.m_paths.few_cells : m_grid.m_paths.far_cells);
  if (same_block) {
    others &= ~(1u << own.level);
    const std::uint64_t* p_words = level.words.data();
    const std::uint32_t cell_mask = level.word_mask << 6 | 63;
    const auto corner = own.cell + static_cast<std::uint32_t>((x0 - own_x) + (y0 - own_y) * 64);
    const auto width = static_cast<unsigned>(x1 - x0);
    for (std::uint32_t row = 0; row <= static_cast<std::uint32_t>(y1 - y0); ++row) {
      const std::uint32_t first = (corner + row * 64) & cell_mask;
      for (std::uint64_t seen = p_words[first >> 6] >> (first & 63) & ((std::uint64_t{2} << width) - 1);
           seen != 0; seen &= seen - 1) {
        const Slot head = level.heads[first + static_cast<std::uint32_t>(std::countr_zero(seen))];
        test(head & ~kMore, s, box.corner, high);
        if ((head & kMore) == 0) continue;
        for (Slot t = m_p_records[head & ~kMore].next; t != kNone; t = m_p_records[t].next) {
          test(t, s, box.corner, high);
        }
      }
    }
  }
  for (; others != 0; others &= others - 1) visit(std::countr_zero(others), s, box);
  return m_count == 0;
}

inline void Grid::Steps::test(Slot t, Slot self, FixedVector low, FixedVector high) {
  const FixedVector corner = m_p_positions[t] + m_p_boxes[t].corner;
  const FixedVector far = corner + m_p_boxes[t].size;
  // All four differences must not be negative.
  const Fixed apart = (high.x - corner.x) | (far.x - low.x) | (high.y - corner.y) | (far.y - low.y);
  const bool touches = (apart >= 0) & (t != self);
  if (m_count < kFew) {  // counted, not asked: nobody can foresee the answer
    m_few[m_count] = t;
    m_count += touches ? 1 : 0;
  } else if (touches) {
    found(t);
  }
}

void Grid::Steps::visit(int level, Slot s, const FixedBox& box) {
  const FixedVector high = box.corner + box.size;
  m_grid.visitCorners(level, box.corner - largest(level), high,
                      [&](Slot t) { test(t, s, box.corner, high); });
}

}  // namespace df
