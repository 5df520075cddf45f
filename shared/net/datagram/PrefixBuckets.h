// A token bucket for each of the last few thousand address prefixes, in fixed memory.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "shared/net/base/TokenBucket.h"
#include "shared/net/datagram/Path.h"

namespace naiad {

/// When there are too many prefixes, the one that was quiet for longest among four makes room and would begin
/// anew with a full bucket. So whoever can forge every address can at most have everybody's allowance filled
/// up. 160 KiB, allocated once.
class PrefixBuckets {
 public:
  using Time = TokenBucket::Time;

  static constexpr std::size_t kWays = 4;
  static constexpr std::size_t kEntries = 4096;

  /// `seed` should be unpredictable, so that nobody can choose whose place to take.
  PrefixBuckets(BucketRate rate, std::uint64_t seed);

  bool take(const PrefixKey& prefix, Time now);

 private:
  struct Entry {
    PrefixKey prefix;
    bool used = false;
    TokenBucket bucket;
  };
  using Set = std::array<Entry, kWays>;

  BucketRate rate_;
  std::uint64_t seed_;
  std::unique_ptr<std::array<Set, kEntries / kWays>> sets_;
};

}  // namespace naiad
