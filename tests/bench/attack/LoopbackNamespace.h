// A network of this process's own: a loopback device with addresses that no other machine has.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace bench::attack {

/// Enter a new network namespace (and user namespace, so that no right is needed), with these IPv6 addresses
/// on its loopback device. Before any thread is started. Why that is not possible here, without blanks;
/// nothing if it is done.
std::optional<std::string> enterLoopbackNamespace(const std::vector<std::string>& addresses);

}  // namespace bench::attack
