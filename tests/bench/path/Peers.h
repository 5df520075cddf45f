// The programs that the suite `path` compares, and how each is started at both ends of the link.
#pragma once

#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "Worker.h"
#include "tests/support/Text.h"

namespace bench::path {

using Words = std::vector<std::string>;

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

inline constexpr const char* kSshPort = "2222";
constexpr const char* kMoshPort = "60001";
constexpr const char* kGamePort = "9876";
constexpr const char* kWebPort = "8443";

inline void writeFile(const std::string& name, const std::string& text) {
  std::ofstream file(name);
  if (!(file << text << std::flush)) throw std::runtime_error(name + " cannot be written");
}

inline void append(Words& words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
}

/// Returns the words in an environment variable, split at blanks.
inline Words fromEnvironment(const char* name) {
  const char* value = std::getenv(name);
  std::istringstream text(value != nullptr ? value : "");
  Words words;
  for (std::string word; text >> word;) words.push_back(word);
  return words;
}

inline Words sceneCommand(const Place& place) {
  return {"env", "LC_ALL=C.UTF-8", place.bin + "/naiad_scene_curses", place.truth(),
          std::to_string(place.seed)};
}

inline void makeKey(const std::string& file) {
  if (runProgram({"ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", file}).code != 0) {
    throw std::runtime_error("ssh-keygen failed");
  }
}

inline void makeSshKeys(const Place& place, const std::string& host_key) {
  makeKey(host_key);
  makeKey(place.file("user_key"));
  writeFile(place.file("known_hosts"),
            "[" + place.address + "]:" + kSshPort + " " + naiad::test::contentOf(host_key + ".pub"));
}

/// Returns the command of this user's own sshd, with keys that exist only during the run.
inline Words sshServer(const Place& place) {
  makeSshKeys(place, place.file("host_key"));
  writeFile(place.file("sshd_config"), std::string("Port ") + kSshPort + "\nListenAddress " + place.address +
                                           "\nHostKey " + place.file("host_key") + "\nAuthorizedKeysFile " +
                                           place.file("user_key.pub") + "\nPidFile " +
                                           place.file("sshd.pid") +
                                           "\nUsePAM no\nStrictModes no\nPermitRootLogin yes\n"
                                           "PasswordAuthentication no\nPrintMotd no\nPrintLastLog no\n");
  if (geteuid() == 0) mkdir("/run/sshd", 0755);  // sshd's privilege separation directory when run as root
  return {"/usr/sbin/sshd", "-D", "-e", "-f", place.file("sshd_config")};
}

/// Returns the command for ssh to this user's sshd, without the remote command.
inline Words sshClient(const Place& place, bool compressed) {
  const passwd* user = getpwuid(geteuid());
  if (user == nullptr) throw std::runtime_error("this user has no name");
  Words words = {
      "ssh", "-F", "none", "-tt", "-e", "none", "-q", "-p", kSshPort, "-i", place.file("user_key")};
  append(words, {"-o", "IdentitiesOnly=yes", "-o", "StrictHostKeyChecking=yes"});
  append(words, {"-o", "UserKnownHostsFile=" + place.file("known_hosts"), "-o", "BatchMode=yes"});
  if (compressed) words.emplace_back("-C");
  words.push_back(std::string(user->pw_name) + "@" + place.address);
  return words;
}

inline Peer ssh(const Place& place, bool compressed) {
  Peer peer;
  peer.server = sshServer(place);
  peer.ready_file = place.file("sshd.pid");
  peer.client = sshClient(place, compressed);
  append(peer.client, sceneCommand(place));
  return peer;
}

/// mosh-server starts a server in the background and prints the key for mosh-client, so ssh is not needed.
inline Peer mosh(const Place& place) {
  Peer peer;
  const std::string answer = place.file("mosh");
  peer.ready_file = answer;
  peer.server = {"sh", "-c", R"(answer=$1; shift; "$@" >"$answer.part" 2>&1 && mv "$answer.part" "$answer")",
                 "sh", answer};
  append(peer.server, {"env", "LC_ALL=C.UTF-8", "mosh-server", "new", "-i", place.address, "-p", kMoshPort});
  append(peer.server, {"-c", "256", "--"});
  append(peer.server, sceneCommand(place));
  peer.client = {
      "sh",     "-c",   R"(MOSH_KEY=$(sed -n 's/^MOSH CONNECT [0-9]* //p' "$1") exec mosh-client "$2" "$3")",
      "sh",     answer, place.address,
      kMoshPort};
  return peer;
}

/// The run has its own HOME, so that its certificates and pins are separate from the user's.
inline Peer dfclient(const Place& place, bool udp) {
  Peer peer;
  peer.ready_file = place.file("port");
  peer.server = {"env", "HOME=" + place.folder, "NAIAD_SCENE_TRUTH=" + place.truth(),
                 "NAIAD_SCENE_SEED=" + std::to_string(place.seed)};
  // The option --in-process is needed because the scene writes its truth file, which a sandboxed game must
  // not.
  append(peer.server,
         {place.bin + "/dfserver", "--in-process", "--game", place.bin + "/../lib/naiad_scene_game.so"});
  append(peer.server, {"--address", place.address, "--port", kGamePort, "--port-file", peer.ready_file});
  append(peer.server, fromEnvironment("NAIAD_PATH_DFSERVER"));
  peer.client = {"env", "HOME=" + place.folder, place.bin + "/dfclient", place.address + ":" + kGamePort};
  append(peer.client, {"--name", "judge"});
  append(peer.client, fromEnvironment("NAIAD_PATH_DFCLIENT"));
  peer.first_keys = "\x1ds";  // Ctrl-] s: hides the client's status, which would cover a part of the scene
  peer.arrows = true;
  peer.udp = udp;
  return peer;
}

/// Returns the words quoted for sh. They must not contain quotes.
inline std::string quoted(const Words& words) {
  std::string text;
  for (const std::string& word : words) text.append("'").append(word).append("' ");
  return text;
}

inline void makeCertificate(const Place& place, const std::string& certificate, const std::string& key) {
  Words command = {"openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256",
                   "-nodes"};
  append(command, {"-days", "2", "-subj", "/CN=bench", "-addext", "subjectAltName=IP:" + place.address});
  append(command, {"-keyout", key, "-out", certificate});
  if (runProgram(command).code != 0) throw std::runtime_error("openssl makes no certificate");
}

/// Creates a folder for a part of this run.
inline std::string makeFolder(const Place& place, const std::string& name) {
  std::filesystem::create_directory(place.file(name));
  return place.file(name);
}

/// Makes a sh script that starts the server with a visitors' socket and then runs `then`, which may use
/// $link, the link printed by dfserver.
inline void leadThrough(const Place& place, Peer& peer, const std::string& then) {
  const std::string printed = quoted({place.file("server.out")});
  append(peer.server, {"--proxy-socket", place.file("visitors")});
  writeFile(place.file("script"), quoted(peer.server) + ">" + printed +
                                      "2>&1 &\nuntil link=$(grep -om1 'naiad://[^ ]*' " + printed +
                                      ") && [ -S " + quoted({place.file("visitors")}) +
                                      "]; do sleep .05; done\n" + then + "wait\n");
  peer.server = {"sh", place.file("script")};
}

/// dfclient through the gateway for browsers: two WebSockets, like a page's. Only the transport differs.
inline Peer web(const Place& place) {
  Peer peer = dfclient(place, false);
  const std::string certificate = place.file("web.pem");
  const std::string key = place.file("web.key");
  const std::string origin = "https://" + place.address + ":" + kWebPort;
  makeCertificate(place, certificate, key);
  const std::string page = makeFolder(place, "page");
  writeFile(page + "/index.html", "");
  peer.ready_file = place.file("web-port");
  Words gateway = {place.bin + "/dfweb", "--proxy-socket", place.file("visitors"), "--page", page};
  append(gateway, {"--listen", place.address + ":" + kWebPort, "--certificate", certificate, "--key", key});
  append(gateway, {"--origin", origin, "--port-file", peer.ready_file});
  leadThrough(place, peer, quoted(gateway) + "\"$link\" &\n");
  peer.client = {"env", "HOME=" + place.folder, "SSL_CERT_FILE=" + certificate, place.bin + "/dfclient",
                 origin};
  append(peer.client, {"--name", "judge"});
  append(peer.client, fromEnvironment("NAIAD_PATH_DFCLIENT"));
  return peer;
}

/// ssh to a door (deploy/door) on the server's machine, which runs dfclient there.
inline Peer sshDoor(const Place& place) {
  Peer peer = dfclient(place, true);
  const std::string script = NAIAD_SOURCE_DIR "/deploy/door";
  const std::string door = makeFolder(place, "door");
  const std::string printed = quoted({place.file("door.out")});
  makeSshKeys(place, door + "/host_key");
  peer.ready_file = place.file("open");
  leadThrough(place, peer,
              quoted({"env", "NAIAD_BIN=" + place.bin, script, "setup", door, "--port", kSshPort, "--address",
                      place.address}) +
                  "&& " + quoted({script, "add", door, "scene"}) + "\"$link\" " +
                  quoted({place.file("visitors")}) + "|| exit\n" + quoted({script, "run", door}) + ">" +
                  printed + "2>&1 &\nuntil grep -q 'Server listening' " + printed +
                  "; do sleep .05; done\n: >" + quoted({peer.ready_file}) + "\n");
  peer.client = sshClient(place, false);
  peer.type_ahead = "judge\r";  // the door asks for a name
  return peer;
}

/// The names of the available programs. ssh is first, because its result validates the runs.
inline const std::vector<std::string> kPeerNames = {"ssh", "ssh-C",   "mosh", "dfclient", "dfclient-stream",
                                                    "web", "ssh-door"};

/// True if the program is a client of this project.
inline bool isOurs(const std::string& program) {
  return program.starts_with("dfclient") || program == "web" || program == "ssh-door";
}

/// Returns why the program cannot be measured on this machine, without blanks; nullopt if it can. If sshd
/// does not run as root, it considers its own user's account locked (OpenSSH 9.2).
inline std::optional<std::string> notPossibleBecause(const std::string& program) {
  if (program.starts_with("ssh") && geteuid() != 0) return "sshd-needs-root";
  return std::nullopt;
}

/// Writes the program's files into the folder and returns its commands. Throws std::runtime_error.
inline Peer preparePeer(const std::string& program, const Place& place) {
  if (program == "ssh" || program == "ssh-C") return ssh(place, program == "ssh-C");
  if (program == "mosh") return mosh(place);
  if (program.starts_with("dfclient")) return dfclient(place, program == "dfclient");
  if (program == "web") return web(place);
  if (program == "ssh-door") return sshDoor(place);
  throw std::runtime_error("there is no program " + program);
}

}  // namespace bench::path
