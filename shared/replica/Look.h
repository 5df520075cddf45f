// The look of an object as data: captured from draw() on the server, drawn by the client.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

#include "shared/replica/LookSelector.h"
#include "shared/values/Canvas.h"
#include "shared/values/Fixed.h"

namespace naiad {

/// One character of an appearance, placed relative to the object's position in units of 1/256 cell. So a
/// sprite of even width, whose cells have half offsets, is drawn in the right cells everywhere.
struct Glyph {
  std::int32_t dx = 0;
  std::int32_t dy = 0;
  char32_t ch = U' ';
  df::Color color = df::COLOR_DEFAULT;

  friend bool operator==(const Glyph&, const Glyph&) = default;
};

inline constexpr int kGlyphUnitBits = 8;  ///< 2^8 glyph units are one cell
/// Maximum distance of a glyph from its object, on an axis, in glyph units (8192 cells).
inline constexpr std::int64_t kMaxGlyphOffset = std::int64_t{1} << (13 + kGlyphUnitBits);

/// A cell of the world or of a view.
struct CellPosition {
  std::int32_t x = 0;
  std::int32_t y = 0;
  friend bool operator==(CellPosition, CellPosition) = default;
};
/// Returns the world cell in which a glyph of an object at `position` is drawn.
CellPosition glyphCell(df::FixedVector position, const Glyph& glyph);

/// The characters of one draw() call, in drawing order.
using Appearance = std::vector<Glyph>;

/// An immutable list of appearances. Copies share its memory, so they are cheap, and objects with equal looks
/// need it only once.
class Sequence {
 public:
  Sequence() = default;
  Sequence(std::initializer_list<Appearance> frames) : Sequence(std::vector<Appearance>(frames)) {}
  explicit Sequence(std::vector<Appearance> frames);

  bool empty() const { return m_p_data == nullptr; }
  std::size_t size() const { return empty() ? 0 : m_p_data->frames.size(); }
  const Appearance& operator[](std::size_t frame) const { return m_p_data->frames[frame]; }
  const Appearance& front() const { return m_p_data->frames.front(); }
  auto begin() const { return frames().begin(); }
  auto end() const { return frames().end(); }
  const std::vector<Appearance>& frames() const;

  /// The number of glyphs in all appearances.
  std::size_t glyphCount() const { return empty() ? 0 : m_p_data->glyphs; }
  /// Returns the size for memory limits: the glyphs, and three for each appearance after the first.
  std::size_t weight() const { return empty() ? 0 : m_p_data->glyphs + 3 * (m_p_data->frames.size() - 1); }
  /// Checksum of the sequence (PROTOCOL.md, "Checksum"); 0 if it is empty.
  std::uint64_t sum() const { return empty() ? 0 : m_p_data->sum; }
  /// Returns the largest distance of a glyph from the object on an axis, in glyph units.
  std::int32_t reach() const { return empty() ? 0 : m_p_data->reach; }
  /// True if all glyphs are whole cells apart, and whole or half cells from the object on each axis.
  bool isWhole() const { return empty() || m_p_data->whole; }
  /// Returns by which part of a cell, in glyph units, all offsets exceed whole cells. Call only if isWhole().
  CellPosition fraction() const { return empty() ? CellPosition{} : m_p_data->fraction; }
  /// True if both share their memory; then they are equal.
  bool isSharedWith(const Sequence& other) const { return m_p_data == other.m_p_data; }
  /// The address of the shared memory; null if empty.
  const void* identity() const { return m_p_data.get(); }

  friend bool operator==(const Sequence& a, const Sequence& b) {
    return a.isSharedWith(b) || (a.sum() == b.sum() && a.frames() == b.frames());
  }

 private:
  struct Data {
    std::vector<Appearance> frames;
    std::size_t glyphs = 0;
    std::uint64_t sum = 0;
    std::int32_t reach = 0;
    CellPosition fraction;
    bool whole = true;
  };
  std::shared_ptr<const Data> m_p_data;
};

/// A sequence of appearances, which may be empty ones, and a selector that both ends evaluate.
struct Look {
  Look() = default;
  Look(Sequence frames, std::int32_t height, Selector chosen_by = {})
      : sequence(std::move(frames)), altitude(height), selector(chosen_by) {}

  Sequence sequence;
  std::int32_t altitude = 2;
  Selector selector;

  /// Returns the appearance shown at `tick`; null if the look draws nothing.
  const Appearance* select(std::uint32_t tick) const {
    return sequence.empty() ? nullptr : &sequence[selector.at(tick, sequence.size())];
  }
  /// True if the selector is kFixed, so the look always shows one appearance.
  friend bool operator==(const Look&, const Look&) = default;
};

/// Returns an equal look whose clock has the latest start that shows the same frames from `tick` on.
Look rebase(const Look& look, std::uint32_t tick);

}  // namespace naiad
