#include "host/settings/SshDoor.h"

#include <algorithm>
#include <cstdint>

namespace naiad {

namespace {

constexpr std::uint16_t kSshPort = 22;

}  // namespace

std::optional<SshDoor> SshDoor::parse(std::string_view text) {
  const std::size_t at = text.find('@');
  if (at == std::string_view::npos || at == 0 || text.front() == '-') return std::nullopt;
  const std::string_view user = text.substr(0, at);
  const bool is_plain = std::all_of(user.begin(), user.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  });
  const auto where = LinkHost::parse(text.substr(at + 1), kSshPort);
  if (!is_plain || !where) return std::nullopt;
  return SshDoor{std::string(user), *where};
}

std::string SshDoor::command() const {
  const std::string port = where.port == kSshPort ? "" : "-p " + std::to_string(where.port) + " ";
  return "ssh -o IgnoreUnknown=ObscureKeystrokeTiming -o ObscureKeystrokeTiming=no " + port + user + "@" +
         where.host;
}

}  // namespace naiad
