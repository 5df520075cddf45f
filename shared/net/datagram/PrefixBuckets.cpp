#include "shared/net/datagram/PrefixBuckets.h"

#include <algorithm>

#include "shared/values/SplitMix64.h"

namespace naiad {

PrefixBuckets::PrefixBuckets(BucketRate rate, std::uint64_t seed)
    : rate_(rate), seed_(seed), sets_(std::make_unique<std::array<Set, kEntries / kWays>>()) {}

bool PrefixBuckets::take(const PrefixKey& prefix, Time now) {
  const std::uint64_t hash = SplitMix64(SplitMix64(prefix.bits ^ seed_).next() + seed_).next();
  Set& set = (*sets_)[hash % sets_->size()];
  const auto found = std::find_if(set.begin(), set.end(),
                                  [&](const Entry& entry) { return entry.used && entry.prefix == prefix; });
  if (found != set.end()) return found->bucket.take(rate_, now);
  const auto quiet = std::min_element(set.begin(), set.end(), [](const Entry& a, const Entry& b) {
    return a.used != b.used ? !a.used : a.bucket.last() < b.bucket.last();
  });
  *quiet = {.prefix = prefix, .used = true, .bucket = {}};
  return quiet->bucket.take(rate_, now);
}

}  // namespace naiad
