// Snapshots and updates as only a hostile peer writes them: the fields in the order of the protocol, all of
// them in their ranges but one, which may hold any number.
//
// One bad field at a time, since a decoder refuses the whole for the first one that it notices: a check that
// is missing shows only where nothing else is wrong. And a byte of the script for a field, so that what the
// fuzzer changes is one number and not the place of all bits behind it.
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
  /// Of each snapshot or update the first byte of the script says which field is the bad one: of which kind,
  /// and which of them. If there is none such, all is in order.
  explicit HostileWriter(Script& script) : m_script(script) {}

  /// Of the given number and tick, in epoch 0, for a client that knows the world of the prelude (Prelude.h).
  std::string snapshot(std::uint32_t number, std::uint32_t tick);
  std::string update();

 private:
  /// Numbers that have a limit. What may be anything cannot be bad.
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
    kMissing,
    kInputs,
    kTicks,
    kBehind,
    kKey,
    kAction,
    kMouse,
    kFrames,
    kSelector
  };

  void begin();
  std::uint64_t any();
  /// At most `most`. In the bad field: any number, and often one that is just beyond `limit`.
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
  int m_good_before = 0;  ///< fields of the bad one's kind that are good, still
  std::uint64_t m_slot = 0;
};

}  // namespace naiad::fuzz
