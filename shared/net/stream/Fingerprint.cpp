#include "shared/net/stream/Fingerprint.h"

#include <algorithm>

#include "shared/net/base/SafeText.h"

namespace naiad {

std::optional<Fingerprint> Fingerprint::parse(std::string_view text) {
  Fingerprint result;
  const auto bytes = text.size() == 2 * result.bytes_.size() ? bytesOfHex(text) : std::nullopt;
  if (!bytes) return std::nullopt;
  std::copy(bytes->begin(), bytes->end(), result.bytes_.begin());
  return result;
}

std::string Fingerprint::text() const {
  return hexText({reinterpret_cast<const char*>(bytes_.data()), bytes_.size()});
}

}  // namespace naiad
