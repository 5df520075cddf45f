// Values for the fields of messages, and bytes that are nearly messages.
#pragma once

#include <cstdint>
#include <string>

#include "shared/values/SplitMix64.h"

namespace naiad::test {

/// Values as fields have them: of all sizes, more small than large.
class RandomFields {
 public:
  explicit RandomFields(std::uint64_t seed) : m_random(seed) {}

  std::uint64_t below(std::uint64_t limit) { return m_random.next() % limit; }
  bool flag() { return below(2) != 0; }
  /// Of 64 bits; setters take what fits.
  std::uint64_t number();
  /// How many elements a repeated field has.
  int count() { return static_cast<int>(below(16) == 0 ? below(20) : below(3)); }
  /// Valid UTF-8.
  std::string text();
  std::string bytes();

 private:
  std::size_t length();

  SplitMix64 m_random;
};

/// Changes `bytes` as an attacker or a broken peer would: flips, cuts, repeats and moves pieces, adds fields
/// with any key, wire type and length, closes and opens groups. `other` is another message, whose pieces get
/// in between.
void mutate(RandomFields& random, std::string& bytes, const std::string& other);

/// Fields with any keys and fitting or unfitting values, some of them in one another.
std::string randomFields(RandomFields& random, int depth);

}  // namespace naiad::test
