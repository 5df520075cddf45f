// Reads a payload of the bus: one flat JSON object (RFC 8259) of kMaxBusPayload bytes at most. Payloads are
// as untrusted as a client's: what is missing, of another kind or out of range makes the whole unreadable.
// Members that are not known are left out, so that a fleet may have servers of two versions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "shared/json/Json.h"

namespace naiad {

inline constexpr std::size_t kMaxBusPayload = 2048;

class BusFields {
 public:
  explicit BusFields(std::string_view payload);

  /// All that was asked for was there and good.
  bool ok() const { return m_ok; }

  /// True if the payload has the member, as a text, a number or a flag.
  bool has(std::string_view name) const;

  // Of a member; fails, and is empty, for one that is not so.

  std::int64_t number(std::string_view name, std::int64_t least, std::int64_t most);
  bool flag(std::string_view name);
  /// Drawable characters only, `most` of them; an empty one is good.
  std::string line(std::string_view name, std::size_t most);
  /// As it stands, `most` bytes of printable ASCII.
  std::string word(std::string_view name, std::size_t most);

 private:
  Json m_object;
  bool m_ok = true;
};

}  // namespace naiad
