// dfdir: the directory of a fleet. It hears on the bus which servers there are, and writes the list of them.
#include <cstdio>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "server/directory/Directory.h"
#include "shared/options/Options.h"
#include "shared/program/BrokenPipes.h"
#include "shared/values/Version.h"

namespace {

enum ExitCode { kUsage = 2, kFile = 5 };

constexpr const char* kHelp =
    "Servers say on the bus that they are there (dfserver --bus). One that says nothing for 6 s is left out; "
    "while the\n"
    "bus itself is gone the list stays as it is, for 10 minutes. SIGHUP opens the log again; SIGTERM and "
    "SIGINT end it,\n"
    "and remove the list.\n\n"
    "Exit codes: 2 wrong usage; 5 a file cannot be written.\n";

struct CommandLine {
  naiad::DirectorySettings settings;
  std::string log_file;
};

std::vector<naiad::Option> optionsOf(CommandLine& line) {
  naiad::DirectorySettings& settings = line.settings;
  return {
      {.name = "--bus",
       .target = &settings.bus.url,
       .help = "The NATS server on which servers say what plays on them: nats://HOST:PORT or tls://HOST:PORT "
               "(other users see the command line: a password rather in --bus-credentials)",
       .environment = "NAIAD_BUS",
       .type = "URL",
       .is_secret = true},
      {.name = "--bus-credentials",
       .target = &settings.bus.credentials,
       .help = "File of credentials for the bus, as nsc writes it",
       .environment = "NAIAD_BUS_CREDENTIALS",
       .type = "FILE"},
      {.name = "--bus-ca",
       .target = &settings.bus.authorities,
       .help = "Certificates (PEM) by which that of a tls:// bus is judged; default: the system's",
       .environment = "NAIAD_BUS_CA",
       .type = "FILE"},
      {.name = "--list",
       .target = &settings.list,
       .help = "Write the list of servers to this file, for a web server and dfclient --list-url",
       .type = "FILE"},
      {.name = "--log-file",
       .target = &line.log_file,
       .help = "Append log lines to this file instead of stderr",
       .type = "FILE"}};
}

/// What is missing or does not go together; nothing if all is well.
std::string problemOf(const naiad::DirectorySettings& settings) {
  if (settings.bus.url.empty()) return "--bus is wanted: the NATS server of the fleet";
  if (settings.list.empty()) return "--list is wanted: where the list is to be written";
  return naiad::busComplaint(settings.bus);
}

void serve(const CommandLine& line) {
  const auto lines = std::make_shared<naiad::LineLog>(line.log_file);
  const naiad::LogLine log = [lines](const naiad::LogEvent& event) { (*lines)(event); };
  naiad::Directory directory(line.settings, log);
  directory.heedSignals();
  log(std::string("dfdir ") + naiad::kVersion + " writes " + line.settings.list);
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
  naiad::surviveBrokenPipes();
  serve(line);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return start(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "dfdir: %s\n", error.what());
    return kFile;
  }
}
