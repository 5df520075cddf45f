#include "host/auth/LoginRateLimit.h"

namespace naiad {

LoginRateLimit::Answer LoginRateLimit::beginTry(const AddressPrefix& from, Time now) {
  Entry& entry = table_.use(from);
  if (!entry.since || now - *entry.since >= window_) {
    entry.since = now;
    entry.wrong = 0;
  }
  if (entry.wrong >= wrong_per_window_) return Answer::kTooMany;
  if (entry.wrong + entry.under_way >= wrong_per_window_) return Answer::kWait;
  ++entry.under_way;
  return Answer::kAllowed;
}

void LoginRateLimit::finishTry(const AddressPrefix& from, bool right) {
  Entry* const entry = table_.find(from);
  if (entry == nullptr) return;  // evicted meanwhile
  if (entry->under_way > 0) --entry->under_way;
  if (!right) ++entry->wrong;
  if (entry->under_way == 0 && entry->wrong == 0) table_.erase(from);
}

void LoginRateLimit::giveUpTry(const AddressPrefix& from, Time now) {
  finishTry(from, true);
  GivenUp& tries = given_up_.use(from);
  if (!tries.since || now - *tries.since >= window_) tries = {now, 0};
  ++tries.count;
}

int LoginRateLimit::wrong(const AddressPrefix& from) {
  const Entry* const entry = table_.find(from);
  return entry != nullptr ? entry->wrong : 0;
}

int LoginRateLimit::givenUp(const AddressPrefix& from, Time now) {
  const GivenUp* const tries = given_up_.find(from);
  return tries != nullptr && now - *tries->since < window_ ? tries->count : 0;
}

}  // namespace naiad
