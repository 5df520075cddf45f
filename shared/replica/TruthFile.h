// The truth file: the correct picture of each player at each tick. `dfserver --truth-file` writes it from the
// engine's own display (not from the encoder), and `dfbot --truth-file` compares its replica with it.
//
// Text, one record per tick and player, in the order of ticks:
//
//   tick 120 player 1 80 24      tick, player, width, height
//   …                            24 lines of 80 characters (UTF-8)
//   …                            24 lines of 80 colour digits 0-7; '.' where the character is a blank
//                                an empty line
//
// A file that is still being written may end anywhere; an incomplete last record is ignored.
#pragma once

#include <cstdint>
#include <fstream>
#include <optional>
#include <string>

#include "shared/values/Canvas.h"

namespace naiad {

class TruthWriter {
 public:
  /// Creates or empties the file. Check isGood(): the directory may not exist, the disk may be full.
  explicit TruthWriter(const std::string& path);

  /// Appends one record and passes it to the operating system.
  void write(std::uint32_t tick, std::uint32_t player, const df::Canvas& canvas);
  bool isGood() const { return m_out.good(); }

 private:
  std::ofstream m_out;
  std::string m_buffer;
};

struct TruthRecord {
  std::uint32_t tick = 0;
  std::uint32_t player = 0;
  df::Canvas canvas;
};

class TruthReader {
 public:
  explicit TruthReader(const std::string& path);
  bool isOpen() const { return m_in.is_open(); }

  /// Returns the next record; nullopt at the end, at an incomplete record, or at invalid bytes (then
  /// isMalformed()).
  std::optional<TruthRecord> next();
  bool isMalformed() const { return m_malformed; }

 private:
  std::ifstream m_in;
  bool m_malformed = false;
};

}  // namespace naiad
