// dfweb: the gateway for browsers. It serves the page and connects its WebSockets to one dfserver.
#include <sys/un.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <sstream>
#include <system_error>
#include <utility>

#include "server/gateway/Gateway.h"
#include "server/gateway/PageFiles.h"
#include "shared/net/base/SafeFile.h"
#include "shared/options/Options.h"
#include "shared/program/ProcessSetup.h"
#include "shared/values/Version.h"

namespace {

namespace fs = std::filesystem;

enum ExitCode { kUsage = 2, kNoPage = 3, kCannotListen = 4, kFile = 5 };

constexpr const char* kHelp =
    "LINK is the link that dfserver prints, SOCKET its --proxy-socket. Browsers can reach no other server.\n"
    "Without a certificate dfweb listens on loopback addresses only. SIGHUP reopens the log and reloads the\n"
    "certificate; SIGTERM and SIGINT tell players and exit. dfweb can read players' passwords and chat.\n\n"
    "Exit codes: 2 wrong usage; 3 no page found; 4 cannot listen; 5 a file cannot be written.\n";

/// Number of file descriptors for other purposes than connections.
constexpr std::size_t kOwnFiles = 64;

struct WebOptions {
  naiad::GatewaySettings settings;
  std::string link;
  std::string listen = "127.0.0.1:8080";
  int max_visitors = 1000;
  int max_per_address = 64;
  std::string port_file;
  std::string log_file;
};

std::string storeListen(const std::string& text, naiad::GatewaySettings& settings) {
  return naiad::Gateway::parseListen(text, settings)
             ? ""
             : "expected ADDRESS:PORT, like 127.0.0.1:8080 or [::]:443";
}

/// `text`: origins, separated by blanks.
std::string storeOrigins(const std::string& text, naiad::GatewaySettings& settings) {
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const auto origin = naiad::WebOrigin::parse(word);
    if (!origin) return "expected https://NAME[:PORT], without a path";
    settings.origins.push_back(*origin);
  }
  return "";
}

std::string storeLink(const std::string& text, naiad::GatewaySettings& settings) {
  const auto parsed = naiad::JoinLink::parse(text);
  if (const auto* const problem = std::get_if<naiad::LinkError>(&parsed)) return problem->message;
  settings.link = std::get<naiad::JoinLink>(parsed);
  return settings.link->room.empty() ? "" : "dfweb requires a link without a room: remove what follows the /";
}

/// Returns the folder of the installed page; if it does not exist, that of the build tree.
fs::path ownPage() {
  std::error_code error;
  const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
  const fs::path installed = folder / "../share/dragonfly/web";
  return fs::exists(installed, error) ? installed : folder / "../web";
}

std::vector<naiad::Option> optionsOf(WebOptions& web) {
  naiad::GatewaySettings& settings = web.settings;
  naiad::Option origins = naiad::typedOption(
      "--origin", "URL",
      naiad::StoreText([&settings](const std::string& text) { return storeOrigins(text, settings); }),
      "Additional address by which players reach dfweb, like https://play.example; may be repeated");
  origins.joins = true;
  return {naiad::typedOption("link", "LINK", naiad::StoreText([&settings](const std::string& text) {
                               return storeLink(text, settings);
                             }),
                             "Link to the server, as dfserver prints it: naiad://HOST[:PORT]#KEY"),
          naiad::typedOption("--proxy-socket", "SOCKET", &settings.visitors,
                             "Visitors' socket of that server: the value of its --proxy-socket"),
          {.name = "--listen",
           .target =
               naiad::StoreText([&settings](const std::string& text) { return storeListen(text, settings); }),
           .help = "Address where browsers connect; port 0: any free port",
           .type = "ADDRESS:PORT",
           .default_text = web.listen},
          naiad::typedOption("--certificate", "FILE", &settings.certificate,
                             "Certificate for HTTPS with its chain, in PEM form"),
          naiad::typedOption("--key", "FILE", &settings.key, "Private key of --certificate (PEM)"),
          std::move(origins),
          naiad::typedOption("--page", "DIR", &settings.page,
                             "Folder with the page's files (default: the one installed with this program)"),
          {.name = "--name",
           .target = &settings.name,
           .help = "Name of the server on the page (default: its host)"},
          {.name = "--max-visitors",
           .target = &web.max_visitors,
           .help = "Maximum number of players at a time, each with up to two WebSockets",
           .range = naiad::OptionRange{1, 20'000},
           .shows_default = true},
          {.name = "--max-per-address",
           .target = &web.max_per_address,
           .help = "Maximum number of players from one IPv4 address or IPv6 network (/64)",
           .range = naiad::OptionRange{1, 20'000},
           .shows_default = true},
          naiad::typedOption("--port-file", "FILE", &web.port_file,
                             "Write the port number to this file once listening"),
          naiad::typedOption("--log-file", "FILE", &web.log_file,
                             "Append log lines to this file instead of stderr")};
}

/// Returns a message about missing or conflicting options; empty if they are valid.
std::string problemOf(const naiad::GatewaySettings& settings) {
  if (settings.visitors.empty()) return "--proxy-socket is required: the visitors' socket of the server.";
  if (settings.visitors.size() >= sizeof(sockaddr_un::sun_path))
    return "--proxy-socket: the path is too long for a socket.";
  if (settings.certificate.empty() != settings.key.empty())
    return "--certificate and --key must be used together.";
  return "";
}

/// Raises the limit of open files to two for each WebSocket and one for each pending connection.
void allowFiles(const naiad::GatewaySettings& settings, const naiad::LogLine& log) {
  const std::size_t wanted = 4 * settings.max_visitors + settings.max_pending + kOwnFiles;
  const std::size_t allowed = naiad::raiseOpenFileLimit(wanted);
  if (allowed < wanted)
    log("only " + std::to_string(allowed) + " of the " + std::to_string(wanted) +
        " open files that --max-visitors may require are allowed (ulimit -n)");
}

void serve(WebOptions& web) {
  const auto lines = std::make_shared<naiad::LineLog>(web.log_file);
  const naiad::LogLine log = [lines](const std::string& line) { (*lines)(line); };
  allowFiles(web.settings, log);
  naiad::Gateway gateway(web.settings, log);
  gateway.installSignalHandlers();
  if (!web.port_file.empty()) naiad::publishFile(web.port_file, std::to_string(gateway.port()) + "\n");
  for (const std::string& address : gateway.addresses()) std::printf("Players open %s\n", address.c_str());
  std::fflush(stdout);
  log(std::string("dfweb ") + naiad::kVersion + " connects browsers on port " +
      std::to_string(gateway.port()) + " to " + web.settings.link->text());
  gateway.run();
}

int start(int argc, char** argv) {
  WebOptions web;
  web.settings.page = ownPage();
  const naiad::Program program{"dfweb", "Lets players join with a browser.", kHelp};
  if (const auto code = naiad::exitCodeOf(naiad::parseOptions(program, optionsOf(web), argc, argv)))
    return *code;
  web.settings.max_visitors = static_cast<std::size_t>(web.max_visitors);
  web.settings.max_per_address = static_cast<std::size_t>(web.max_per_address);
  if (const std::string problem = problemOf(web.settings); !problem.empty()) {
    std::fprintf(stderr, "dfweb: %s\nRun dfweb --help for more information.\n", problem.c_str());
    return kUsage;
  }
  naiad::ignoreBrokenPipes();
  serve(web);
  return 0;
}

int fail(ExitCode code, const char* what) {
  std::fprintf(stderr, "dfweb: %s\n", what);
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return start(argc, argv);
  } catch (const naiad::PageError& error) {
    return fail(kNoPage, error.what());
  } catch (const naiad::GatewayError& error) {
    return fail(kCannotListen, error.what());
  } catch (const std::exception& error) {
    return fail(kFile, error.what());
  }
}
