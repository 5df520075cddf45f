// A WorldView <-> the fields of a frame (WorldFrame.h).
//
// Each tick's frame has everything, but for what many ticks share: sequences of looks and tables of controls
// are written once, with a number, and later by that number.
#pragma once

#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "engine/world/WorldView.h"
#include "host/world/WorldFrame.h"
#include "shared/replica/Look.h"

namespace naiad {

/// With more numbers than that of one kind, both ends forget them before the next view.
inline constexpr std::size_t kMaxViewNumbers = 4096;

/// Players of a world, at most, with those who are just leaving it.
inline constexpr std::size_t kMaxViewPlayers = 32'768;

class ViewWriter {
 public:
  void write(FieldWriter& out, const df::WorldView& view);

 private:
  friend struct ViewFields;
  /// Numbers by address; what has one is kept, so that its address is not used again.
  std::unordered_map<const void*, std::uint32_t> m_sequences;
  std::vector<Sequence> m_kept_sequences;
  std::unordered_map<const void*, std::uint32_t> m_tables;
  std::vector<std::shared_ptr<const df::ControlTable>> m_kept_tables;
};

class ViewReader {
 public:
  /// `later`: is added to the tick numbers of views.
  explicit ViewReader(std::uint32_t later = 0) : m_later(later) {}
  /// The reader fails where anything is wrong; `view` and this are good for nothing then.
  void read(FieldReader& in, df::WorldView& view);

 private:
  friend struct ViewFields;
  std::uint32_t m_later;
  std::vector<Sequence> m_sequences;
  std::vector<std::shared_ptr<const df::ControlTable>> m_tables;
};

}  // namespace naiad
