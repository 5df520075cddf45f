#include "shared/fleet/SendOn.h"

#include <variant>

#include "shared/fleet/BusFields.h"
#include "shared/fleet/ServerId.h"
#include "shared/json/Json.h"

namespace naiad {

namespace {

constexpr std::int64_t kSendOnFormat = 1;
constexpr std::size_t kMaxLink = 512;

}  // namespace

std::string SendOn::payload() const {
  return Json{{"v", kSendOnFormat}, {"to", to}, {"link", link.text()}}.toString();
}

// A link in another spelling is none that a directory writes.
std::optional<SendOn> SendOn::parse(std::string_view payload) {
  BusFields fields(payload);
  fields.number("v", kSendOnFormat, kSendOnFormat);
  const std::string to = fields.word("to", kMaxServerId);
  const std::string text = fields.word("link", kMaxLink);
  const auto parsed = JoinLink::parse(text);
  const auto* const p_link = std::get_if<JoinLink>(&parsed);
  const bool good = fields.ok() && isServerId(to) && p_link != nullptr && p_link->text() == text;
  return good ? std::optional(SendOn{to, *p_link}) : std::nullopt;
}

}  // namespace naiad
