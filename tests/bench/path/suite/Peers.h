// The programs that the suite `path` compares, and how each is started at both ends of the link.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace bench::path {

/// Folders and addresses of one run.
struct Place {
  std::string bin;      ///< folder of our programs
  std::string folder;   ///< this run's own folder for keys, logs and truth
  std::string address;  ///< the server's address as the client sees it
  std::uint64_t seed = 1;

  std::string file(const std::string& name) const { return folder + "/" + name; }
  std::string truth() const { return file("truth"); }
};

/// Commands for both ends of the link, and how to use the client.
struct Peer {
  std::vector<std::string> server;  ///< runs the server, or starts one in the background
  std::string ready_file;           ///< file that exists when clients may connect
  std::vector<std::string> client;  ///< shows the scene in its terminal
  std::string type_ahead;           ///< bytes typed at the start
  std::string first_keys;           ///< bytes typed when the scene is first shown
  bool arrows = false;              ///< the scene accepts arrow keys, whose effect the client may predict
  bool udp = true;                  ///< false: the link drops UDP
};

/// Returns the names of the available programs. ssh is first, because its result validates the runs.
const std::vector<std::string>& peerNames();
/// True if the program is a client of this project.
bool isOurs(const std::string& program);
/// Returns why the program cannot be measured on this machine, without blanks; nullopt if it can.
std::optional<std::string> notPossibleBecause(const std::string& program);
/// Writes the program's files into the folder and returns its commands. Throws std::runtime_error.
Peer preparePeer(const std::string& program, const Place& place);

}  // namespace bench::path
