// dfdoor: runs dfclient for each visitor of an ssh door. sshd starts it by ForceCommand (deploy/door). It
// identifies the visitor and asks which game they want. Of the text that they type, only their name gets
// into a command line, after cleaning.
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "client/door/DoorSlots.h"
#include "client/door/GamesList.h"
#include "shared/net/base/SafeFile.h"
#include "shared/net/base/SafeText.h"
#include "shared/net/stream/ByteStream.h"
#include "shared/net/stream/ProxyHeader.h"
#include "shared/options/Options.h"

namespace naiad {
namespace {

// Questions to the visitor before the game, answered in lines on their terminal.

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMaxLine = 200;  // bytes
constexpr int kMaxTries = 3;

/// Reads a byte from the terminal. Nullopt if none comes before `end`, or the terminal is gone.
std::optional<char> readByte(Clock::time_point end) {
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now());
    if (left.count() <= 0) return std::nullopt;
    pollfd ready{STDIN_FILENO, POLLIN, 0};
    const int count = ::poll(&ready, 1, static_cast<int>(left.count()));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return std::nullopt;
    char byte = 0;
    const ssize_t size = ::read(STDIN_FILENO, &byte, 1);
    if (size < 0 && errno == EINTR) continue;
    if (size != 1) return std::nullopt;
    return byte;
  }
}

std::optional<std::size_t> choiceOf(const std::string& answer, const std::vector<std::string>& names) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (answer == names[i] || answer == std::to_string(i + 1)) return i;
  }
  return std::nullopt;
}

/// Prints `question` and reads a line. Nullopt after `timeout`, without a terminal, or beyond 200 bytes.
std::optional<std::string> promptLine(const std::string& question, std::chrono::seconds timeout) {
  std::fputs(question.c_str(), stdout);
  std::fflush(stdout);
  const auto end = Clock::now() + timeout;
  std::string line;
  while (line.size() <= kMaxLine) {
    const auto byte = readByte(end);
    if (!byte) return std::nullopt;
    if (*byte == '\n') return line;
    line.push_back(*byte);
  }
  return std::nullopt;
}

/// Asks for a game; returns its index. Nullopt like promptLine(), or after three invalid answers.
std::optional<std::size_t> promptChoice(const std::vector<std::string>& names, std::chrono::seconds timeout) {
  for (std::size_t i = 0; i < names.size(); ++i) std::printf("%3zu  %s\n", i + 1, names[i].c_str());
  for (int i = 0; i < kMaxTries; ++i) {
    const auto answer = promptLine("Which game? ", timeout);
    if (!answer) return std::nullopt;
    if (const auto choice = choiceOf(*answer, names)) return choice;
    std::printf("Type a number from 1 to %zu.\n", names.size());
  }
  return std::nullopt;
}

/// Asks for the player's name; an empty line means `known`. Nullopt like promptLine().
std::optional<std::string> promptName(const std::string& known, std::chrono::seconds timeout) {
  const auto answer = promptLine(known.empty() ? "Your name? " : "Your name? [" + known + "] ", timeout);
  if (!answer) return std::nullopt;
  const bool is_blank =
      std::all_of(answer->begin(), answer->end(), [](char c) { return c == ' ' || c == '\r'; });
  return is_blank && !known.empty() ? known : safeName(*answer);
}

/// Asks a question; the answer is yes unless it begins with n or N. Nullopt like promptLine().
std::optional<bool> promptYes(const std::string& question, std::chrono::seconds timeout) {
  const auto answer = promptLine(question + " [y] ", timeout);
  if (!answer) return std::nullopt;
  return !answer->starts_with('n') && !answer->starts_with('N');
}

}  // namespace
}  // namespace naiad

namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

enum ExitCode { kUsage = 2, kRefused = 3, kNoTerminal = 5 };

constexpr const char* kHelp =
    "sshd runs this program for each visitor of a door; deploy/door sets up a door. It reads "
    "SSH_CONNECTION,\n"
    "SSH_USER_AUTH and TERM, and refuses to run a command (SSH_ORIGINAL_COMMAND).\n\n"
    "Lines of games.list: NAME LINK SOCKET [password]. SOCKET is the --proxy-socket of the game's "
    "dfserver.\n\n"
    "Exit codes: 2 wrong usage, a command was requested, or games.list is invalid; 3 no free place;\n"
    "5 no terminal; else those of dfclient.\n";

constexpr std::chrono::seconds kPromptTimeout{60};  // limit for an answer of the visitor
constexpr std::chrono::seconds kTakeOver{10};       // limit for the visitor's other client to end
constexpr std::chrono::milliseconds kStep{50};      // interval between attempts to lock the folder
constexpr std::size_t kMaxList = 65'536;            // maximum bytes of games.list
constexpr std::size_t kMaxTerm = 64;
constexpr std::size_t kMaxAuthInfo = 65'536;

/// Limits of each visitor's client: bytes of data, and seconds of processor time. The largest terminal takes
/// a quarter of the data.
constexpr std::pair<decltype(RLIMIT_DATA), rlim_t> kClientLimits[] = {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // their shadow memory counts as data
    {RLIMIT_DATA, rlim_t{128} << 20},
#endif
    {RLIMIT_CPU, 7200},
    {RLIMIT_CORE, 0}};

struct DoorOptions {
  fs::path games;
  fs::path state;
  std::string client;
  naiad::DoorSlot::Limits limits;
  int idle_limit = 600;
};

/// Thrown to refuse a visitor: the exit code, and a sentence for them.
struct Refusal {
  ExitCode code;
  std::string sentence;
};

// ---- signals ----------------------------------------------------------------------------------------------

volatile sig_atomic_t g_client = 0;
volatile sig_atomic_t g_end = 0;  // the signal that ends this program

extern "C" void passOn(int signal) {
  g_end = signal;
  if (g_client > 0) ::kill(static_cast<pid_t>(g_client), signal);
}

/// Ignores the stop signals: a visitor has no shell from which to resume the program.
void ignoreStops() {
  for (const int signal : {SIGTSTP, SIGTTIN, SIGTTOU}) ::signal(signal, SIG_IGN);
}

/// Passes SIGHUP (the terminal is gone) and SIGTERM (the door closes) on to the client, which must end first.
/// Ignores SIGINT and SIGQUIT.
void passOnEnds() {
  for (const int signal : {SIGINT, SIGQUIT}) ::signal(signal, SIG_IGN);
  struct sigaction action {};
  action.sa_handler = passOn;
  for (const int signal : {SIGHUP, SIGTERM}) ::sigaction(signal, &action, nullptr);
}

// ---- the visitor ------------------------------------------------------------------------------------------

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

/// Returns the visitor's address from SSH_CONNECTION: "192.0.2.7 50312 198.51.100.1 22", of which the second
/// half is sshd's own address. Throws Refusal if it is malformed.
asio::ip::tcp::endpoint visitorOf(const std::string& connection) {
  const std::size_t blank = connection.find(' ');
  const std::string address = connection.substr(0, blank);
  const std::string rest = blank == std::string::npos ? "" : connection.substr(blank + 1);
  const std::string port = rest.substr(0, rest.find(' '));
  const auto visitor = naiad::proxiedPeerFromText(
      (address.find(':') == std::string::npos ? address : "[" + address + "]") + ":" + port);
  if (!visitor) throw Refusal{kUsage, "This program must be started by sshd."};
  return *visitor;
}

/// Returns `asked` if it is a safe file name, else a default, because ncurses opens a file of that name.
std::string terminalType(const std::string& asked) {
  const bool is_plain =
      !asked.empty() && asked.size() <= kMaxTerm && asked.front() != '.' &&
      std::all_of(asked.begin(), asked.end(), [](unsigned char c) {
        return c < 0x80 && (std::isalnum(c) != 0 || c == '-' || c == '_' || c == '+' || c == '.');
      });
  return is_plain ? asked : "xterm-256color";
}

naiad::GamesList readGames(const fs::path& path) {
  auto list = naiad::GamesList::parse(naiad::readSmallFile(path, kMaxList).value_or(""));
  if (!list.problem.empty())
    throw Refusal{kUsage, "The list of games is invalid, " + list.problem + ". Please tell the host."};
  if (list.games.empty()) throw Refusal{kUsage, "This door has no games yet."};
  return list;
}

std::unique_ptr<naiad::DoorSlot> takePlace(const DoorOptions& options,
                                           const asio::ip::tcp::endpoint& visitor) {
  auto taken = naiad::DoorSlot::acquire(options.state / "places", naiad::peerName(visitor), options.limits);
  if (taken.place) return std::move(taken.place);
  throw Refusal{kRefused, taken.refusal == naiad::DoorSlot::Refusal::kFull
                              ? "All places are taken. Try again later."
                              : "Too many players from your address. Try again later."};
}

/// Asks a visitor already playing whether to continue in this terminal. If so, ends the other client, which
/// may have a dead connection. Returns true if this process has then locked `folder`. Throws Refusal without
/// an answer.
bool takeOver(naiad::VisitorFolder& folder) {
  const auto yes =
      naiad::promptYes("You are already playing here. Continue that game in this terminal?", kPromptTimeout);
  if (!yes) throw Refusal{kRefused, ""};
  const pid_t holder = folder.holder();
  if (!*yes || holder == 0) return false;
  ::kill(holder, SIGHUP);
  for (const auto end = std::chrono::steady_clock::now() + kTakeOver;
       std::chrono::steady_clock::now() < end;) {
    if (folder.acquire()) return true;
    std::this_thread::sleep_for(kStep);
  }
  return false;
}

/// Returns the locked folder of the visitor's key. Null without a key, or if opening or locking it fails.
std::unique_ptr<naiad::VisitorFolder> folderOf(const DoorOptions& options) {
  const std::string auth_file = variable("SSH_USER_AUTH");
  const auto name = auth_file.empty()
                        ? std::nullopt
                        : naiad::keyFolderName(naiad::readSmallFile(auth_file, kMaxAuthInfo).value_or(""));
  if (!name) return nullptr;
  auto folder = naiad::VisitorFolder::open(options.state / "keys", *name);
  if (folder && (folder->acquire() || takeOver(*folder))) return folder;
  return nullptr;
}

// ---- the game ---------------------------------------------------------------------------------------------

struct ClientStart {
  std::vector<std::string> words;
  std::vector<std::string> environment;
};

ClientStart clientStart(const DoorOptions& options, const naiad::OfferedGame& game, const std::string& name,
                        const asio::ip::tcp::endpoint& visitor, const fs::path& folder) {
  ClientStart start;
  // Each server key has its own file of known servers: when a server's key changes, the host puts the new one
  // into games.list, and an old pin must not refuse it.
  start.words = {options.client,
                 game.link.text(),
                 "--name=" + name,
                 "--proxy-socket=" + game.socket,
                 "--proxy-for=" + naiad::peerName(visitor),
                 "--known-servers=" + (folder / ("known-" + game.link.key.text())).string(),
                 "--idle-limit=" + std::to_string(options.idle_limit)};
  if (game.needs_password) start.words.push_back("--ask-password");
  start.environment = {"PATH=/usr/bin:/bin", "LC_ALL=C.UTF-8", "TERM=" + terminalType(variable("TERM"))};
  for (const char* home : {"HOME", "XDG_CONFIG_HOME", "XDG_DATA_HOME", "XDG_STATE_HOME"})
    start.environment.push_back(std::string(home) + "=" + folder.string());
  return start;
}

std::vector<char*> pointersTo(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// Runs the client to its end and returns its exit code, or 128 and the number of the signal that ended it.
/// The child calls only async-signal-safe functions.
int runClient(ClientStart start) {
  const std::vector<char*> words = pointersTo(start.words);
  const std::vector<char*> environment = pointersTo(start.environment);
  passOnEnds();
  const pid_t child = ::fork();
  if (child == 0) {
    for (const int signal : {SIGHUP, SIGTERM, SIGINT, SIGQUIT}) ::signal(signal, SIG_DFL);
    for (const auto& [resource, limit] : kClientLimits) {
      const rlimit both{limit, limit};
      ::setrlimit(resource, &both);
    }
    ::execve(words[0], words.data(), environment.data());
    ::_exit(127);
  }
  if (child < 0) throw Refusal{kRefused, "The game cannot be started now. Try again later."};
  g_client = static_cast<sig_atomic_t>(child);
  if (g_end != 0) ::kill(child, g_end);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  g_client = 0;
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127)
    throw Refusal{kUsage, "The door cannot run dfclient. Please tell the host."};
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

int serveVisitor(const DoorOptions& options) {
  if (std::getenv("SSH_ORIGINAL_COMMAND") != nullptr)
    throw Refusal{kUsage, "This door does not run commands. Connect without a command."};
  if (::isatty(STDIN_FILENO) == 0 || ::isatty(STDOUT_FILENO) == 0)
    throw Refusal{kNoTerminal, "A terminal is required: use ssh -t."};
  ignoreStops();
  const auto visitor = visitorOf(variable("SSH_CONNECTION"));
  const naiad::GamesList list = readGames(options.games);
  const auto place = takePlace(options, visitor);
  auto folder = folderOf(options);

  std::vector<std::string> names;
  for (const naiad::OfferedGame& game : list.games) names.push_back(game.name);
  const auto choice =
      names.size() == 1 ? std::optional<std::size_t>(0) : naiad::promptChoice(names, kPromptTimeout);
  const auto name = choice ? naiad::promptName(folder ? folder->name() : "", kPromptTimeout) : std::nullopt;
  if (!name) throw Refusal{kRefused, "Goodbye."};
  if (folder) {
    folder->saveName(*name);
  } else {
    folder = naiad::VisitorFolder::makeTemporary(options.state / "visits");
  }
  return runClient(clientStart(options, list.games[*choice], *name, visitor, folder->path()));
}

std::string besideThisProgram() {
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  return error ? "/usr/bin/dfclient" : (self.parent_path() / "dfclient").string();
}

std::vector<naiad::Option> optionsOf(DoorOptions& door) {
  std::vector<naiad::Option> options{
      naiad::typedOption("--games", "FILE", &door.games, "File with the games to offer, one per line"),
      naiad::typedOption("--state", "DIR", &door.state, "Folder for the visitors' data"),
      naiad::typedOption("--client", "FILE", &door.client,
                         "The dfclient to run (default: the one in this program's folder)"),
      {.name = "--max-visitors",
       .target = &door.limits.total,
       .help = "Maximum number of visitors at a time",
       .range = naiad::OptionRange{1, 1000},
       .shows_default = true},
      {.name = "--max-per-address",
       .target = &door.limits.per_prefix,
       .help = "Maximum number of visitors from one IPv4 address or IPv6 network (/64)",
       .range = naiad::OptionRange{1, 1000},
       .shows_default = true},
      {.name = "--idle-limit",
       .target = &door.idle_limit,
       .help = "Seconds without a key or mouse movement after which a visitor is disconnected; 0: never",
       .range = naiad::OptionRange{0, 86'400, naiad::kSecond},
       .shows_default = true}};
  return options;
}

int start(int argc, char** argv) {
  DoorOptions options;
  options.client = besideThisProgram();
  const naiad::Program program{"dfdoor", "Lets the visitor of an ssh door play a game.", kHelp};
  if (const auto code = naiad::exitCodeOf(naiad::parseOptions(program, optionsOf(options), argc, argv)))
    return *code;
  if (options.games.empty() || options.state.empty())
    throw Refusal{kUsage, "--games and --state are required."};
  ::umask(077);
  return serveVisitor(options);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return start(argc, argv);
  } catch (const Refusal& refusal) {
    if (!refusal.sentence.empty()) std::fprintf(stderr, "%s\n", refusal.sentence.c_str());
    return refusal.code;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "Cannot start the game: %s. Please tell the host.\n", error.what());
    return kUsage;
  }
}
