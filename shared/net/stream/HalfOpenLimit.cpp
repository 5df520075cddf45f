#include "shared/net/stream/HalfOpenLimit.h"

#include <stdexcept>

namespace naiad {

HalfOpenLimit::Answer HalfOpenLimit::admit(const AddressPrefix& prefix) {
  if (count_ >= most_) return Answer::kFull;
  const std::size_t* const held = by_prefix_.find(prefix);
  if (held != nullptr && *held >= most_per_prefix_) return Answer::kFullForPrefix;
  ++by_prefix_.use(prefix);
  ++count_;
  return Answer::kAdmitted;
}

void HalfOpenLimit::release(const AddressPrefix& prefix) {
  std::size_t* const held = by_prefix_.find(prefix);
  if (held == nullptr) throw std::logic_error("released more than was admitted");
  if (--*held == 0) by_prefix_.erase(prefix);
  --count_;
}

}  // namespace naiad
