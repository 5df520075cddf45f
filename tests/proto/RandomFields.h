// Random values for fields of messages, and bytes that are almost messages.
#pragma once

#include <cstdint>
#include <string>

#include "shared/values/SplitMix64.h"

namespace naiad::test {

/// Makes random values of all sizes, more small than large ones.
class RandomFields {
 public:
  explicit RandomFields(std::uint64_t seed) : m_random(seed) {}

  std::uint64_t below(std::uint64_t limit) { return m_random.next() % limit; }
  bool flag() { return below(2) != 0; }
  /// Returns a 64-bit number; setters take the bits that fit.
  std::uint64_t number();
  /// Returns a number of elements for a repeated field.
  int count() { return static_cast<int>(below(16) == 0 ? below(20) : below(3)); }
  /// Returns valid UTF-8.
  std::string text();
  std::string bytes();

 private:
  std::size_t length();

  SplitMix64 m_random;
};

/// Changes `bytes` like an attacker or a broken peer: flips, cuts, repeats and moves pieces, adds fields with
/// any key, wire type and length, closes and opens groups. Inserts pieces of the message `other`.
void mutate(RandomFields& random, std::string& bytes, const std::string& other);

/// Returns fields with any keys and valid or invalid values, some of them nested.
std::string randomFields(RandomFields& random, int depth);

}  // namespace naiad::test
