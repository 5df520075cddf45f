// dfclient: play a game that a dfserver hosts, in this terminal.
#include <sys/prctl.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>

#include "client/session/TrustOptions.h"
#include "client/terminal/TerminalGuard.h"
#include "client/ui/ClientApp.h"
#include "shared/net/base/SafeText.h"
#include "shared/values/Version.h"

namespace {

std::string footer() {
  std::string text = "Keys of the client (every other key is the game's):\n";
  for (const char* line : naiad::kClientKeyHelp) text += std::string("  ") + line + "\n";
  text += "\n";
  text += naiad::kExitCodeHelp;
  text += "\nNO_COLOR in the environment switches colours off.";
  return text;
}

std::string defaultName() {
  const char* user = std::getenv("USER");
  return naiad::safeName(user != nullptr ? user : "");
}

int complain(naiad::ExitCode code, const std::string& sentence) {
  std::fprintf(stderr, "dfclient: %s\n", sentence.c_str());
  return code;
}

/// Say from the `from`-th on what was not right with the file. How many there are.
std::size_t tellProblems(const naiad::SessionFile* p_file, std::size_t from) {
  if (p_file == nullptr) return 0;
  for (std::size_t i = from; i < p_file->problems().size(); ++i) {
    std::fprintf(stderr, "dfclient: %s\n", p_file->problems()[i].c_str());
  }
  return p_file->problems().size();
}

int play(const naiad::ClientApp::Options& options, bool attached) {
  if (!naiad::TerminalGuard::isTerminal()) {
    return complain(naiad::kExitNoTerminal,
                    "standard input and output must be a terminal (dfbot needs none).");
  }
  const char* term = std::getenv("TERM");
  if (term == nullptr || *term == '\0') {
    return complain(naiad::kExitNoTerminal, "TERM is not set: what kind of terminal is this?");
  }
  naiad::ClientApp::Outcome outcome;
  const std::size_t told = tellProblems(options.p_session_file, 0);
  {
    naiad::ClientApp app(options);
    outcome = app.run();
  }
  tellProblems(options.p_session_file, told);
  if (outcome.signal != 0) {
    // The terminal is restored; now die of the signal, so that the parent process sees it.
    std::signal(outcome.signal, SIG_DFL);
    std::raise(outcome.signal);
  }
  // Whoever runs a game in his terminal sees that it is over.
  if (attached && outcome.code == naiad::kExitEnded) return outcome.code;
  if (!outcome.sentence.empty()) std::fprintf(stderr, "dfclient: %s\n", outcome.sentence.c_str());
  return outcome.code;
}

int start(int argc, char** argv) {
  naiad::ClientApp::Options options;
  std::string server;
  options.session.name = defaultName();
  options.session.program = std::string("dfclient ") + naiad::kVersion;
  bool no_mouse = false;
  bool no_resume = false;
  bool attached = false;

  CLI::App app("Play a Dragonfly game on a Naiad server.", "dfclient");
  app.set_version_flag("--version", std::string("dfclient ") + naiad::kVersion);
  app.add_option("server", server, "Where the server is: HOST[:PORT], [::1]:PORT (port 9876 by default)")
      ->required()
      ->type_name("HOST[:PORT]")
      ->envname("NAIAD_SERVER");
  const CLI::Option* name = app.add_option("--name", options.session.name,
                                           "Your name in the game, 1 to 16 characters (default: $USER)")
                                ->envname("NAIAD_NAME");
  app.add_option("--game", options.session.game, "The game you want; refused if another one runs")
      ->envname("NAIAD_GAME");
  naiad::addTrustOptions(app, options.trust, options.session);
  app.add_flag("--no-resume", no_resume,
               "Do not go on with the session of a client that was killed, nor leave yours to the next")
      ->envname("NAIAD_NO_RESUME");
  app.add_flag("--ascii", options.ascii, "Draw with ASCII characters only")->envname("NAIAD_ASCII");
  app.add_flag("--no-mouse", no_mouse, "Leave the mouse to the terminal")->envname("NAIAD_NO_MOUSE");
  app.add_option_function<std::string>(
         "--sound",
         [&options](const std::string& word) {
           const auto mode = naiad::soundModeFrom(word);
           if (!mode) throw CLI::ValidationError("--sound", "bell, note or off is wanted");
           options.sound = *mode;
         },
         "What a sound of the game does: bell (and note), note (its name in the status line), off")
      ->default_str("note")
      ->type_name("bell|note|off")
      ->envname("NAIAD_SOUND");
  app.add_flag("--attached", attached, "Started by the game, to end with it")->group("");
  app.footer(footer());
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? naiad::kExitLeft : naiad::kExitUsage;
  }

  // The terminal must not be left to the picture of a game that has crashed.
  if (attached) prctl(PR_SET_PDEATHSIG, SIGTERM);

  const auto address = naiad::ServerAddress::parse(server);
  if (!address) {
    return complain(naiad::kExitUsage,
                    "\"" + naiad::safeText(server, 100) + "\" is no server: HOST[:PORT] is wanted.");
  }
  options.address = *address;
  options.mouse = !no_mouse;
  const char* no_color = std::getenv("NO_COLOR");
  options.colors = no_color == nullptr || *no_color == '\0';
  std::optional<naiad::SessionFile> file;
  const auto directory = naiad::SessionFile::defaultDirectory();
  if (directory && !no_resume && !options.trust.insecure) {
    const auto wanted = name->count() > 0 ? std::optional(options.session.name) : std::nullopt;
    file.emplace(*directory, address->canonicalText(), wanted, std::chrono::system_clock::now());
    options.p_session_file = &*file;
  }
  try {
    return play(options, attached);
  } catch (const std::runtime_error& error) {
    return complain(naiad::kExitNoTerminal, error.what());
  }
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
