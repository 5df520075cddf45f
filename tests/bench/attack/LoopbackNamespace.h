// A network of this process: a loopback device with additional addresses.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace bench::attack {

/// Enters a new network namespace (and user namespace, so that no privilege is needed), with these IPv6
/// addresses on its loopback device. Call before starting threads. Returns nullopt on success, otherwise the
/// reason without blanks.
std::optional<std::string> enterLoopbackNamespace(const std::vector<std::string>& addresses);

}  // namespace bench::attack
