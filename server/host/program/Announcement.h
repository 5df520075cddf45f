// Tells people and scripts, at a server's start, its address and how to join.
#pragma once

#include <string>
#include <vector>

namespace naiad {

class Host;
struct HostOptions;

/// "Join from this machine with: dfclient …", and how from elsewhere.
std::vector<std::string> howToJoin(const Host& host);
/// HostOptions::port_file and join_file, if they are asked for. Throws std::runtime_error if one cannot be
/// written.
void writeWhereabouts(const HostOptions& options, const Host& host);

}  // namespace naiad
