// What a server says when it begins: where it is and how to join, to people and to scripts.
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
