// The programs that the suite `path` compares, and how each is started at both ends of the link.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace bench::path {

/// Environment of one run.
struct Place {
  std::string bin;      ///< folder of our programs
  std::string folder;   ///< this run's own folder for keys, logs and truth
  std::string address;  ///< the server's address as the client sees it
  std::uint64_t seed = 1;

  std::string file(const std::string& name) const { return folder + "/" + name; }
  std::string truth() const { return file("truth"); }
};

/// Commands for both ends.
struct Peer {
  std::vector<std::string> server;  ///< keeps running, or leaves a server in the background
  std::string ready_file;           ///< exists when clients may connect
  std::vector<std::string> client;  ///< shows the scene in its terminal
  std::string type_ahead;           ///< typed at the start
  std::string first_keys;           ///< typed once the scene is shown
  bool arrows = false;              ///< has arrow keys whose effect the client may predict
  bool udp = true;                  ///< false: the link drops UDP
};

/// Returns the available programs. ssh is first, because it validates the runs.
const std::vector<std::string>& peerNames();
/// True if it is one of ours.
bool isOurs(const std::string& program);
/// Returns why it cannot be measured here, without blanks; nullopt if it can.
std::optional<std::string> notPossibleBecause(const std::string& program);
/// Writes the program's files into the folder and returns its commands. Throws std::runtime_error.
Peer preparePeer(const std::string& program, const Place& place);

}  // namespace bench::path
