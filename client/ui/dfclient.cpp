// dfclient: plays a game of a dfserver in this terminal.
#include <poll.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "client/lan/DiscoveredServers.h"
#include "client/lan/LanBrowser.h"
#include "client/lan/ListDownload.h"
#include "client/session/TrustOptions.h"
#include "client/terminal/HiddenLine.h"
#include "client/terminal/TerminalGuard.h"
#include "client/terminal/TerminalType.h"
#include "client/trust/SessionFile.h"
#include "client/ui/ClientApp.h"
#include "client/ui/ServerChooser.h"
#include "shared/options/Options.h"
#include "shared/values/Version.h"

namespace {

struct CommandLine {
  naiad::ClientApp::Options play;
  naiad::ServerChoice server;
  bool named = false;  ///< --name was given
  bool no_mouse = false;
  bool no_resume = false;
  bool attached = false;
  bool ask_password = false;
  bool list = false;
  std::optional<naiad::ListUrl> list_url;
  bool json = false;
  int idle_limit = 0;  ///< seconds
};

std::string footer() {
  std::string text = "Keys of the client (all other keys go to the game):\n";
  for (const char* line : naiad::kClientKeyHelp) text += std::string("  ") + line + "\n";
  text += "\n";
  text += naiad::kExitCodeHelp;
  text += "\nNO_COLOR in the environment switches colours off.";
  return text;
}

std::string defaultName() {
  const char* user = std::getenv("USER");
  return user != nullptr ? user : "";
}

int complain(naiad::ExitCode code, const std::string& message) {
  std::fprintf(stderr, "dfclient: %s\n", message.c_str());
  return code;
}

/// Prints the problems with the file from index `from` on. Returns the number of all problems.
std::size_t printProblems(const naiad::SessionFile* p_file, std::size_t from) {
  if (p_file == nullptr) return 0;
  for (std::size_t i = from; i < p_file->problems().size(); ++i) {
    std::fprintf(stderr, "dfclient: %s\n", p_file->problems()[i].c_str());
  }
  return p_file->problems().size();
}

std::string passwordQuestion(const naiad::ServerAddress& server) {
  return "Password of " + server.text() + ": ";
}

/// Ends this process by the signal that ended the client, so that the parent process sees it. Call after the
/// terminal is restored. Does nothing for 0.
void endBySignal(int signal) {
  if (signal == 0) return;
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

bool usesColors() {
  const char* no_color = std::getenv("NO_COLOR");
  return no_color == nullptr || *no_color == '\0';
}

/// Returns the servers of this network that answer within LanBrowser::kResponseTimeout.
naiad::DiscoveredServers findServers() {
  using Clock = std::chrono::steady_clock;
  naiad::LanBrowser browser;
  std::vector<pollfd> waited;
  for (const int descriptor : browser.descriptors()) waited.push_back({descriptor, POLLIN, 0});
  const auto end = Clock::now() + naiad::LanBrowser::kResponseTimeout;
  for (auto now = Clock::now(); now < end; now = Clock::now()) {
    browser.update(now);
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(std::min(end, browser.nextQuery()) - now);
    ::poll(waited.data(), waited.size(), static_cast<int>(left.count()));
    browser.receiveAnswers();
  }
  return browser.servers();
}

std::variant<naiad::DiscoveredServers, naiad::DownloadError> fetchServers(const naiad::ListUrl& url) {
  auto fetched = naiad::downloadList(url);
  if (auto* p_problem = std::get_if<naiad::DownloadError>(&fetched)) return *p_problem;
  auto servers = naiad::readServerList(std::get<std::string>(fetched));
  if (!servers) return naiad::DownloadError{"The document is not a server list."};
  return *std::move(servers);
}

/// Implements --list: prints the servers of this network, or of --list-url.
int printServers(const CommandLine& line) {
  naiad::DiscoveredServers found;
  if (line.list_url) {
    auto fetched = fetchServers(*line.list_url);
    if (const auto* p_problem = std::get_if<naiad::DownloadError>(&fetched))
      return complain(naiad::kExitUnreachable, p_problem->message);
    found = std::get<naiad::DiscoveredServers>(std::move(fetched));
  } else {
    found = findServers();
  }
  const auto servers = found.sorted();
  const std::string none = line.list_url ? "The list has no servers.\n" : naiad::serversAsText({});
  const std::string text = line.json         ? naiad::serversAsJson(servers)
                           : servers.empty() ? none
                                             : naiad::serversAsText(servers);
  std::fputs(text.c_str(), stdout);
  return naiad::kExitLeft;
}

/// Lets the player choose a server on the screen. Returns the exit code if the player joins none.
std::optional<int> chooseServer(CommandLine& line) {
  // A door must name the server, because its visitors get no list. Without a terminal, no list can be shown.
  const bool is_visit = !line.server.visitors.empty() || !line.server.visitor.empty();
  if (is_visit || !naiad::TerminalGuard::isTerminal())
    return complain(naiad::kExitUsage, "server is required\nRun dfclient --help for more information.");
  // Any chosen server would get the password.
  if (!line.play.session.password.empty() && !line.server.is_password_ambient)
    return complain(naiad::kExitUsage,
                    "--password requires SERVER; to choose from a list use --ask-password.");
  if (line.play.trust.insecure) return complain(naiad::kExitUsage, "--insecure requires SERVER.");
  naiad::ServerChooser::Outcome outcome;
  try {
    naiad::ServerChooser::Options options{naiad::chooseTerminalType(std::getenv("TERM")), line.play.ascii,
                                          usesColors()};
    if (line.list_url) options.fetch = [url = *line.list_url] { return fetchServers(url); };
    naiad::ServerChooser chooser(std::move(options));
    outcome = chooser.run();
  } catch (const std::runtime_error& error) {
    return complain(naiad::kExitNoTerminal, error.what());
  }
  endBySignal(outcome.signal);
  if (!outcome.server) return naiad::kExitLeft;
  const std::string link = outcome.server->link();
  line.server.text = link.empty() ? outcome.server->address.text() : link;
  line.server.list_key = outcome.server->key;
  line.ask_password = line.ask_password || outcome.server->requires_password;
  return std::nullopt;
}

/// Returns what is wrong with the options about lists; empty if nothing is.
std::string listComplaint(const CommandLine& line) {
  const char* p_ambient = std::getenv("NAIAD_SERVER");
  const bool is_named = !line.server.text.empty() && (p_ambient == nullptr || line.server.text != p_ambient);
  if (line.json && !line.list) return "--json requires --list.";
  if ((line.list || line.list_url) && is_named) return "--list and --list-url cannot be used with SERVER.";
  return {};
}

/// Joins, and like ssh asks for the server's password if needed, at most three times. The question contains
/// only the address that the player gave. The password is sent only to the server whose key asked for it.
naiad::ClientApp::Outcome joinWithPassword(naiad::ClientApp::Options& options) {
  constexpr int kTries = 3;
  naiad::ClientApp::Outcome outcome;
  for (int tried = 0;; ++tried) {
    {
      naiad::ClientApp app(options);
      outcome = app.run();
    }
    if (!outcome.password_required_by || options.session.proxy || tried == kTries) return outcome;
    if (tried > 0) std::fputs("Wrong password, try again.\n", stderr);
    const auto password = naiad::readHiddenLine(passwordQuestion(options.address));
    if (!password || password->empty()) return outcome;
    options.session.password = *password;
    options.trust.fingerprint = outcome.password_required_by;
  }
}

int play(naiad::ClientApp::Options options, naiad::SessionFile* p_file, bool attached) {
  if (!naiad::TerminalGuard::isTerminal()) {
    return complain(naiad::kExitNoTerminal,
                    "standard input and output must be a terminal (dfbot needs none).");
  }
  // Check this before joining: a client that cannot draw must not leave a player on the server.
  options.terminal = naiad::chooseTerminalType(std::getenv("TERM"));
  options.p_tokens = p_file;
  const std::size_t printed = printProblems(p_file, 0);
  const naiad::ClientApp::Outcome outcome =
      attached ? naiad::ClientApp(options).run() : joinWithPassword(options);
  printProblems(p_file, printed);
  endBySignal(outcome.signal);
  // The game itself runs in this terminal, so the player sees its end without a message.
  if (attached && outcome.code == naiad::kExitEnded) return outcome.code;
  if (!outcome.message.empty()) std::fprintf(stderr, "dfclient: %s\n", outcome.message.c_str());
  return outcome.code;
}

std::vector<naiad::Option> optionsOf(CommandLine& line) {
  naiad::ClientApp::Options& play = line.play;
  const naiad::StoreText store_sound = [&play](const std::string& name) -> std::string {
    const auto mode = naiad::soundModeFrom(name);
    if (mode) play.sound = *mode;
    return mode ? "" : "expected bell, note or off";
  };
  const naiad::StoreText store_menu_key = [&play](const std::string& text) -> std::string {
    const char letter = static_cast<char>(text.size() == 1 ? text[0] & ~0x20 : 0);
    if (letter == 0 || std::string_view("ABDEFGKLNOPQRSTVWXY").find(letter) == std::string_view::npos)
      return "expected a letter other than C, H, I, J, M, U and Z";
    play.menu_letter = letter;
    return "";
  };
  const naiad::StoreText store_url = [&line](const std::string& text) -> std::string {
    line.list_url = naiad::ListUrl::parse(text);
    return line.list_url ? "" : "expected an address that begins with https://";
  };
  naiad::Option server = naiad::serverOption(line.server);
  server.is_optional = true;
  server.help += ". Without it, in a terminal: choose from the servers in this network";
  std::vector<naiad::Option> options = {
      server,
      {"--list", &line.list, "Print the servers in this network, or in the list of --list-url"},
      {"--json", &line.json, "With --list: print JSON"},
      naiad::typedOption("--list-url", "URL", store_url,
                         "Use the server list at this address (https://…) instead of this network"),
      {.name = "--name",
       .target = &play.session.name,
       .help = "Your name in the game, 1 to 16 characters (default: $USER)",
       .environment = "NAIAD_NAME",
       .p_given = &line.named},
      {"--game", &play.session.game, "Game to play; refused if the server does not run it", "NAIAD_GAME"}};
  for (naiad::Option& option : naiad::trustOptions(line.server, play.trust, play.session))
    options.push_back(option);
  const std::vector<naiad::Option> own = {
      {"--ask-password", &line.ask_password, "Ask for the server's password before joining"},
      {"--no-resume", &line.no_resume,
       "Do not resume the session of a killed client, and do not save this one", "NAIAD_NO_RESUME"},
      {"--ascii", &play.ascii, "Draw with ASCII characters only", "NAIAD_ASCII"},
      {"--no-mouse", &line.no_mouse, "Leave the mouse to the terminal", "NAIAD_NO_MOUSE"},
      {.name = "--menu-key",
       .target = store_menu_key,
       .help = "Letter that opens the client's menu together with Ctrl; Ctrl-] opens it, too",
       .environment = "NAIAD_MENU_KEY",
       .type = "LETTER",
       .default_text = "G"},
      {.name = "--sound",
       .target = store_sound,
       .help = "How to signal sounds of the game: bell (and note), note (name in the status line), off",
       .environment = "NAIAD_SOUND",
       .type = "bell|note|off",
       .default_text = "note"},
      {.name = "--idle-limit",
       .target = &line.idle_limit,
       .help = "Leave after this many seconds without key or mouse input; 0: never",
       .environment = "NAIAD_IDLE_LIMIT",
       .range = naiad::OptionRange{0, 86'400, naiad::kSecond}},
      {.name = "--attached",
       .target = &line.attached,
       .help = "Exit when the game that started this client exits",
       .hidden = true}};
  options.insert(options.end(), own.begin(), own.end());
  return options;
}

/// Joins the server that the command line or the list names. Returns the exit code.
int join(CommandLine& line) {
  naiad::ClientApp::Options& options = line.play;
  const std::string wrong =
      naiad::resolveServer(line.server, options.address, options.trust, options.session);
  if (!wrong.empty()) return complain(naiad::kExitUsage, wrong);
  if (line.ask_password) {
    const auto password = naiad::readHiddenLine(passwordQuestion(options.address));
    if (!password)
      return complain(naiad::kExitNoTerminal, "no password was typed, or one longer than 255 bytes.");
    options.session.password = *password;
  }
  options.mouse = !line.no_mouse;
  options.idle_limit = std::chrono::seconds(line.idle_limit);
  options.colors = usesColors();
  std::optional<naiad::SessionFile> file;
  const auto directory = naiad::SessionFile::defaultDirectory();
  if (directory && !line.no_resume && !options.trust.insecure) {
    const auto wanted = line.named ? std::optional(options.session.name) : std::nullopt;
    file.emplace(*directory, options.address.canonicalText(), wanted, std::chrono::system_clock::now());
  }
  try {
    const int code = play(std::move(options), file ? &*file : nullptr, line.attached);
    if (code == naiad::kExitRefused && line.server.dropsPassword() && !line.ask_password)
      std::fputs("dfclient: NAIAD_PASSWORD is not sent to servers given by a link; use --ask-password.\n",
                 stderr);
    return code;
  } catch (const std::runtime_error& error) {
    return complain(naiad::kExitNoTerminal, error.what());
  }
}

int start(int argc, char** argv) {
  CommandLine line;
  naiad::ClientApp::Options& options = line.play;
  options.session.name = defaultName();
  options.session.program = std::string("dfclient ") + naiad::kVersion;
  const naiad::Program program{"dfclient", "Play a Dragonfly game on a Naiad server.", footer()};
  if (const auto code = naiad::exitCodeOf(naiad::parseOptions(program, optionsOf(line), argc, argv)))
    return *code;

  // If the game that started this client crashes, end too, so that its last picture leaves the terminal.
  if (line.attached) prctl(PR_SET_PDEATHSIG, SIGTERM);

  if (const std::string wrong = listComplaint(line); !wrong.empty())
    return complain(naiad::kExitUsage, wrong);
  if (line.list) return printServers(line);
  if (line.server.text.empty() || line.list_url) {
    if (const auto code = chooseServer(line)) return *code;
  }
  return join(line);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return start(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "dfclient: %s\n", error.what());
    return naiad::kExitUsage;
  }
}
