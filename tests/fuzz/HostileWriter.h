// Snapshots and updates as only a hostile peer writes them: the fields in the order of the protocol, with any
// number in any of them. A byte of the script becomes a field, so that what the fuzzer changes is one number
// and not the place of all bits behind it.
#pragma once

#include <cstdint>
#include <string>

#include "Bits.h"
#include "Script.h"

namespace naiad::fuzz {

class HostileWriter {
 public:
  explicit HostileWriter(Script& script) : m_script(script) {}

  /// Of the given number and tick, in epoch 0.
  std::string snapshot(std::uint32_t number, std::uint32_t tick);
  std::string update();

 private:
  std::uint64_t any();
  bool flag();
  std::uint64_t field(int bits);
  std::uint64_t golomb(int order);
  void vector();
  void position();
  int fraction();
  void steps();
  void motion();
  void character();
  void look();
  void body();
  void extras();
  void object();

  Script& m_script;
  BitWriter m_out;
};

}  // namespace naiad::fuzz
