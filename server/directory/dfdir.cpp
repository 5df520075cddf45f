// dfdir: the directory of a fleet. It learns from the bus which servers there are, writes a list of them, and
// redirects players to them.
#include <chrono>
#include <cstdio>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "server/directory/Directory.h"
#include "shared/fleet/BusPayloads.h"
#include "shared/net/base/AddressPrefix.h"
#include "shared/net/base/SafeFile.h"
#include "shared/net/stream/JoinLink.h"
#include "shared/options/Options.h"
#include "shared/program/ProcessSetup.h"
#include "shared/values/Version.h"

namespace {

enum ExitCode { kUsage = 2, kCannotListen = 4, kFile = 5 };

constexpr const char* kHelp =
    "Servers announce themselves on the bus (dfserver --bus). The list drops a server that is silent for\n"
    "three intervals; while the bus is down, it stays unchanged for 10 minutes. SIGHUP reopens the log and\n"
    "reloads the lobby's key; SIGTERM and SIGINT remove the list and exit.\n\n"
    "With --listen this is a lobby: dfclient joins it like a server and is redirected to one with a free\n"
    "place (with --game NAME: to one that runs that game). Like a server, a lobby has a key.\n\n"
    "Exit codes: 2 wrong usage; 4 it cannot listen; 5 a file cannot be read or written.\n";

/// Limit of open files: half-open connections, connections without a hello, and the program's own files.
constexpr std::size_t kOpenFiles = 4096;

struct CommandLine {
  naiad::DirectorySettings settings;
  std::string link_host;
  int max_per_address = 64;
  int interval_ms = static_cast<int>(naiad::Presence::kInterval.count());
  std::string port_file;
  std::string log_file;
};

/// Stores ADDRESS:PORT in the settings of the lobby.
std::string storeListen(const std::string& text, naiad::DirectorySettings& settings) {
  const auto where = naiad::NumericEndpoint::parse(text);
  if (!where) return "expected ADDRESS:PORT, like 0.0.0.0:9875 or [::]:9875; port 0: any free port";
  settings.lobby = naiad::LobbySettings{.address = where->address.to_string(), .port = where->port};
  return "";
}

std::string storeLinkHost(const std::string& text, std::string& host) {
  host = text;
  return naiad::LinkHost::parse(text) ? "" : "expected HOST or HOST:PORT";
}

std::vector<naiad::Option> optionsOf(CommandLine& line) {
  naiad::DirectorySettings& settings = line.settings;
  return {
      {.name = "--bus",
       .target = &settings.bus.url,
       .help = "NATS server of the fleet: nats://HOST:PORT or tls://HOST:PORT (other users can see the "
               "command line: put passwords into --bus-credentials)",
       .environment = "NAIAD_BUS",
       .type = "URL",
       .is_secret = true},
      {.name = "--bus-credentials",
       .target = &settings.bus.credentials,
       .help = "Credentials file for the bus, as written by nsc",
       .environment = "NAIAD_BUS_CREDENTIALS",
       .type = "FILE"},
      {.name = "--bus-ca",
       .target = &settings.bus.authorities,
       .help = "CA certificates (PEM) for a tls:// bus; default: the system's",
       .environment = "NAIAD_BUS_CA",
       .type = "FILE"},
      {.name = "--bus-interval",
       .target = &line.interval_ms,
       .help = "Heartbeat interval, ms; must equal the servers'",
       .environment = "NAIAD_BUS_INTERVAL",
       .range = naiad::OptionRange{naiad::Presence::kMinInterval.count(),
                                   naiad::Presence::kMaxInterval.count(), naiad::kMillisecond},
       .shows_default = true},
      naiad::typedOption("--list", "FILE", &settings.list,
                         "Write the list of servers to this file, for a web server and dfclient --list-url"),
      naiad::typedOption("--listen", "ADDRESS:PORT", naiad::StoreText([&settings](const std::string& text) {
                           return storeListen(text, settings);
                         }),
                         "Address of the lobby, which redirects players to servers; without it, no lobby"),
      naiad::typedOption("--public-host", "HOST[:PORT]", naiad::StoreText([&line](const std::string& text) {
                           return storeLinkHost(text, line.link_host);
                         }),
                         "Host, and port if it differs from --listen, for the printed link"),
      naiad::typedOption(
          "--identity", "DIR", &settings.identity,
          "Folder of the lobby's key, created if missing (default: naiad in your configuration folder)"),
      naiad::typedOption("--certificate", "FILE", &settings.certificate,
                         "Certificate of the lobby (PEM), instead of --identity"),
      naiad::typedOption("--key", "FILE", &settings.key, "Private key of --certificate (PEM)"),
      {.name = "--max-per-address",
       .target = &line.max_per_address,
       .help = "Players that may connect at once from one IPv4 address or IPv6 network (/64)",
       .range = naiad::OptionRange{1, 20'000},
       .shows_default = true},
      naiad::typedOption("--port-file", "FILE", &line.port_file,
                         "Write the port number to this file once listening"),
      naiad::typedOption("--log-file", "FILE", &line.log_file,
                         "Append log lines to this file instead of stderr")};
}

/// Returns a message about missing or conflicting options; empty if they are valid.
std::string problemOf(const naiad::DirectorySettings& settings) {
  if (settings.bus.url.empty()) return "--bus is required: the NATS server of the fleet";
  if (settings.list.empty() && !settings.lobby) return "specify --list FILE, --listen ADDRESS:PORT or both";
  if (settings.certificate.empty() != settings.key.empty())
    return "--certificate and --key must be used together";
  return naiad::validateBusSettings(settings.bus);
}

/// Returns the link to the lobby that is printed and logged.
std::string lobbyLink(const CommandLine& line, const naiad::Directory& directory) {
  const bool is_any = line.settings.lobby->address == "::" || line.settings.lobby->address == "0.0.0.0";
  const std::string given = !line.link_host.empty() ? line.link_host : is_any ? "127.0.0.1" : "";
  naiad::LinkHost where{line.settings.lobby->address, *directory.port()};
  if (!given.empty()) where = *naiad::LinkHost::parse(given, *directory.port());
  return naiad::JoinLink{where, "", naiad::ShortKey::of(*directory.fingerprint())}.text();
}

void announce(const CommandLine& line, const naiad::Directory& directory, const naiad::LogLine& log) {
  if (!line.settings.list.empty()) log("writing the list of servers to " + line.settings.list);
  if (!directory.port()) return;
  if (!line.port_file.empty()) naiad::publishFile(line.port_file, std::to_string(*directory.port()) + "\n");
  const std::string link = lobbyLink(line, directory);
  std::printf("Players join:  dfclient '%s'\n", link.c_str());
  std::fflush(stdout);
  log("redirecting players from " + link);
}

void serve(CommandLine& line) {
  const auto lines = std::make_shared<naiad::LineLog>(line.log_file);
  const naiad::LogLine log = [lines](const naiad::LogEvent& event) { (*lines)(event); };
  line.settings.interval = std::chrono::milliseconds(line.interval_ms);
  if (line.settings.lobby) line.settings.lobby->max_per_address = line.max_per_address;
  naiad::raiseOpenFileLimit(kOpenFiles);
  naiad::Directory directory(line.settings, log);
  directory.installSignalHandlers();
  log(std::string("dfdir ") + naiad::kVersion);
  announce(line, directory, log);
  directory.run();
}

int start(int argc, char** argv) {
  CommandLine line;
  const naiad::Program program{"dfdir", "The directory of a fleet of Naiad servers.", kHelp};
  if (const auto code = naiad::exitCodeOf(naiad::parseOptions(program, optionsOf(line), argc, argv)))
    return *code;
  if (const std::string problem = problemOf(line.settings); !problem.empty()) {
    std::fprintf(stderr, "dfdir: %s\nRun dfdir --help for more information.\n", problem.c_str());
    return kUsage;
  }
  naiad::ignoreBrokenPipes();
  serve(line);
  return 0;
}

int fail(ExitCode code, const char* p_what) {
  std::fprintf(stderr, "dfdir: %s\n", p_what);
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return start(argc, argv);
  } catch (const naiad::ListenError& error) {
    return fail(kCannotListen, error.what());
  } catch (const std::exception& error) {
    return fail(kFile, error.what());
  }
}
