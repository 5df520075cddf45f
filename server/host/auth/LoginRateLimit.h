// How often somebody may be wrong: few tries per address and time, in a table that does not grow.
#pragma once

#include <chrono>
#include <cstddef>
#include <map>

#include "shared/net/base/AddressPrefix.h"

namespace naiad {

/// A try under way counts as wrong until it is known; otherwise many at once would get around the limit.
class LoginRateLimit {
 public:
  using Time = std::chrono::steady_clock::time_point;
  enum class Answer { kAllowed, kTooMany, kWait };

  LoginRateLimit(int wrong_per_window, std::chrono::seconds window, std::size_t prefixes)
      : wrong_per_window_(wrong_per_window), window_(window), prefixes_(prefixes) {}

  /// kAllowed: finish() must follow. kTooMany: was wrong too often. kWait: might have been, with those under
  /// way.
  Answer begin(const AddressPrefix& from, Time now);
  void finish(const AddressPrefix& from, bool right);
  std::size_t size() const { return table_.size(); }

 private:
  struct Entry {
    Time since;  // the first try of the window
    int wrong = 0;
    int under_way = 0;
  };
  void makeRoom(Time now);

  int wrong_per_window_;
  std::chrono::seconds window_;
  std::size_t prefixes_;
  std::map<AddressPrefix, Entry> table_;
};

}  // namespace naiad
