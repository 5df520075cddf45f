// Writes a WorldView to the fields of a frame (WorldFrame.h), and reads it.
//
// A frame has a whole WorldView, except for data that many views share: a sequence of a look or a table of
// controls is written once, with a number, and later as that number.
#pragma once

#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "engine/world/WorldView.h"
#include "host/world/WorldFrame.h"
#include "shared/replica/Look.h"

namespace naiad {

/// If one kind of data has more numbers than this, both ends forget all numbers before the next view.
inline constexpr std::size_t kMaxViewNumbers = 4096;

/// Maximum number of players of a world, including those who are just leaving.
inline constexpr std::size_t kMaxViewPlayers = 32'768;

class ViewWriter {
 public:
  void write(FieldWriter& out, const df::WorldView& view);

 private:
  friend struct ViewFields;
  /// Numbers by address. Everything that has a number is kept, so that its address is not reused.
  std::unordered_map<const void*, std::uint32_t> m_sequences;
  std::vector<Sequence> m_kept_sequences;
  std::unordered_map<const void*, std::uint32_t> m_tables;
  std::vector<std::shared_ptr<const df::ControlTable>> m_kept_tables;
};

class ViewReader {
 public:
  /// `later` is added to the tick numbers in views.
  explicit ViewReader(std::uint32_t later = 0) : m_tick_offset(later) {}
  /// Reads a view. Makes `in` fail if anything is wrong; then neither `view` nor this reader may be used.
  void read(FieldReader& in, df::WorldView& view);

 private:
  friend struct ViewFields;
  std::uint32_t m_tick_offset;
  std::vector<Sequence> m_sequences;
  std::vector<std::shared_ptr<const df::ControlTable>> m_tables;
};

}  // namespace naiad
