// Writes snapshots and updates like a hostile peer: the fields are in the protocol's order and in range,
// except for one, which may have any value.
//
// Only one field is bad, because a decoder rejects the whole message at the first problem, so a missing check
// is found only if all other fields are right. Each field takes one byte of the script, so that a change by
// the fuzzer alters one number and does not shift the bits after it.
#pragma once

#include <cstdint>
#include <string>

#include "Script.h"
#include "shared/net/base/Limits.h"
#include "shared/replica/Bits.h"
#include "shared/replica/Limits.h"

namespace naiad::fuzz {

class HostileWriter {
 public:
  /// The first byte of the script for each snapshot or update selects the bad field by its kind and index. If
  /// there is no such field, all are good.
  explicit HostileWriter(Script& script) : m_script(script) {}

  /// Writes a snapshot in epoch 0 for a client that knows the prelude's world (Prelude.h).
  std::string snapshot(std::uint32_t number, std::uint32_t tick);
  std::string update();

 private:
  /// Kinds of numbers with a limit. Numbers without a limit cannot be bad.
  enum class Kind {
    kCell,
    kVector,
    kWidth,
    kMotion,
    kCharacter,
    kGlyphs,
    kOffset,
    kName,
    kSize,
    kViewWidth,
    kViewHeight,
    kFollowed,
    kSlot,
    kPlace,
    kLength,
    kTexts,
    kControls,
    kGroups,
    kOrder,
    kObjects,
    kId,
    kMissing,  // from here to kMouse: in updates
    kInputs,
    kTicks,
    kBehind,
    kKey,
    kAction,
    kMouse,
    kFrames,
    kSelector
  };

  /// Reads which field is bad: one of the `count` kinds from `first` on.
  void begin(Kind first, int count);
  std::uint64_t any();
  /// Chooses a number of at most `most`, or, in the bad field, any number, often one just beyond `limit`.
  std::uint64_t choose(Kind kind, std::uint64_t most, std::uint64_t limit);
  std::uint64_t choose(Kind kind, std::uint64_t most) { return choose(kind, most, most); }
  std::uint64_t field(int bits);
  std::uint64_t field(Kind kind, int bits, std::uint64_t most);
  bool flag();
  std::uint64_t golomb(Kind kind, int order, std::uint64_t most, std::uint64_t limit);
  std::uint64_t golomb(Kind kind, int order, std::uint64_t most) { return golomb(kind, order, most, most); }
  std::int64_t centered(Kind kind, std::int64_t most);
  void zeros(std::uint64_t count);
  void vector(std::int64_t least, std::int64_t most);
  void cell(std::int64_t origin);
  void position();
  void fraction();
  void steps();
  void motion();
  void character();
  void appearance(bool whole);
  std::uint64_t sequence();
  void selector(std::uint64_t frames);
  void look();
  void body();
  void world();
  void view();
  void origin();
  void text();
  void extras();
  unsigned groups();
  void object();
  void mask();
  void input(bool first);

  Script& m_script;
  BitWriter m_out;
  Kind m_bad{};
  int m_good_before = 0;  ///< good fields of this kind before the bad one
  std::uint64_t m_slot = 0;
};

}  // namespace naiad::fuzz
