#include "host/auth/LoginRateLimit.h"

namespace naiad {

LoginRateLimit::Answer LoginRateLimit::begin(const AddressPrefix& from, Time now) {
  auto place = table_.find(from);
  if (place == table_.end()) {
    makeRoom(now);
    place = table_.emplace(from, Entry{now}).first;
  }
  Entry& entry = place->second;
  if (now - entry.since >= window_) {
    entry.since = now;
    entry.wrong = 0;
  }
  if (entry.wrong >= wrong_per_window_) return Answer::kTooMany;
  if (entry.wrong + entry.under_way >= wrong_per_window_) return Answer::kWait;
  ++entry.under_way;
  return Answer::kAllowed;
}

void LoginRateLimit::finish(const AddressPrefix& from, bool right) {
  const auto place = table_.find(from);
  if (place == table_.end()) return;  // forgotten meanwhile
  Entry& entry = place->second;
  if (entry.under_way > 0) --entry.under_way;
  if (!right) ++entry.wrong;
  if (entry.under_way == 0 && entry.wrong == 0) table_.erase(place);
}

/// Forgets what is over, or else the oldest. Who owns so many prefixes gains nothing by being forgotten under
/// one.
void LoginRateLimit::makeRoom(Time now) {
  if (table_.size() < prefixes_) return;
  std::erase_if(table_, [&](const auto& item) {
    return item.second.under_way == 0 && now - item.second.since >= window_;
  });
  while (table_.size() >= prefixes_) {
    auto oldest = table_.begin();
    for (auto place = table_.begin(); place != table_.end(); ++place) {
      if (place->second.since < oldest->second.since) oldest = place;
    }
    table_.erase(oldest);
  }
}

}  // namespace naiad
