#include "shared/net/stream/HalfOpenLimit.h"

#include <stdexcept>

namespace naiad {

HalfOpenLimit::Answer HalfOpenLimit::admit(const AddressPrefix& prefix) {
  if (count_ >= most_) return Answer::kFull;
  const auto place = by_prefix_.find(prefix);
  if ((place == by_prefix_.end() ? 0 : place->second) >= most_per_prefix_) return Answer::kFullForPrefix;
  ++by_prefix_[prefix];
  ++count_;
  return Answer::kAdmitted;
}

void HalfOpenLimit::release(const AddressPrefix& prefix) {
  const auto place = by_prefix_.find(prefix);
  if (place == by_prefix_.end()) throw std::logic_error("released more than was admitted");
  if (--place->second == 0) by_prefix_.erase(place);
  --count_;
}

}  // namespace naiad
