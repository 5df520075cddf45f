// Limits connections between "accepted" and "handshake done", in all and per address prefix.
#pragma once

#include <cstddef>

#include "shared/net/base/PerAddress.h"

namespace naiad {

class HalfOpenLimit {
 public:
  enum class Answer { kAdmitted, kFull, kFullForPrefix };

  HalfOpenLimit(std::size_t most, std::size_t most_per_prefix)
      : most_(most), most_per_prefix_(most_per_prefix), by_prefix_(most) {}

  /// kAdmitted counts one more, until release().
  Answer admit(const AddressPrefix& prefix);
  /// Once for each admitted. Throws std::logic_error if none is.
  void release(const AddressPrefix& prefix);
  std::size_t count() const { return count_; }

 private:
  std::size_t most_;
  std::size_t most_per_prefix_;
  std::size_t count_ = 0;
  PerAddress<std::size_t> by_prefix_;  // none is zero, so none is ever evicted
};

}  // namespace naiad
