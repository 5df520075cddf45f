// dfctl: sends one command to a server on this machine and prints the answer.
#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "client/ctl/CtlCommandLine.h"
#include "client/terminal/HiddenLine.h"
#include "shared/admin/AdminAnswer.h"
#include "shared/admin/AdminJson.h"
#include "shared/admin/ControlClient.h"
#include "shared/program/LogText.h"
#include "shared/values/Version.h"

namespace {

enum ExitCode { kDone = 0, kRefused = 1, kUsage = 2, kNoServer = 3 };

int failUsage(const std::string& sentence) {
  std::cerr << "dfctl: " << sentence << "\nRun dfctl --help for more information.\n";
  return kUsage;
}

/// Reads a line from standard input; a terminal does not show it.
std::string readSecret() {
  if (isatty(STDIN_FILENO) != 0) {
    const auto line = naiad::readHiddenLine("Password: ");
    if (!line) throw naiad::AdminUsageError("no password was typed, or one longer than 255 bytes.");
    return *line;
  }
  std::string line;
  std::getline(std::cin, line);
  return line;
}

void print(const naiad::AdminAnswer& answer, bool json) {
  std::ostream& out = answer.ok || json ? std::cout : std::cerr;
  if (json) {
    out << naiad::answerJson(answer) << "\n";
    return;
  }
  for (const std::string& line : naiad::answerText(answer)) out << line << "\n";
}

std::string findControl(const std::string& given) {
  if (!given.empty()) return given;
  const auto live = naiad::findControlSockets();
  if (live.empty())
    throw naiad::ServerUnreachable("No server of yours is running; specify another one with --control PATH.");
  if (live.size() == 1) return live.front().string();
  std::string sentence = "Several servers are running; choose one:";
  for (const auto& path : live) sentence += "\n  --control " + path.string();
  throw naiad::AdminUsageError(sentence);
}

int printHelp(const std::string& command) {
  if (command.empty()) {
    std::cout << naiad::ctlHelp();
    return kDone;
  }
  for (const std::string& line : naiad::adminHelp(naiad::requireAdminCommand(command)))
    std::cout << line << "\n";
  return kDone;
}

int give(const naiad::CtlCommandLine& line) {
  std::vector<std::string> words = line.words;
  if (words == std::vector<std::string>{"password"}) words.push_back(readSecret());
  const naiad::AdminRequest request = naiad::readAdminRequest(words);
  if (!request.command->isFor(naiad::AdminCommand::Level::kAdmin, naiad::AdminCommand::Frontend::kSocket))
    throw naiad::AdminUsageError("\"" + request.command->name + "\" is only available in the chat.");
  if (request.command->name == "help") return printHelp(request.of("command"));
  naiad::ControlClient client(findControl(line.control));
  const naiad::AdminAnswer answer = client.sendRequest(request);
  if (request.command->name == "watch" && answer.ok) {
    client.follow([&line](const std::string& text) {
      std::cout << (line.json ? naiad::answerJson(naiad::AdminAnswer::done(text)) : naiad::oneLine(text))
                << std::endl;
    });
    return kDone;
  }
  print(answer, line.json);
  return answer.ok ? kDone : kRefused;
}

int printPage(const std::optional<std::string>& page) {
  if (!page) return failUsage("Expected bash, zsh or fish.");
  std::cout << *page;
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  const auto is = [&words](const std::string& word) { return !words.empty() && words.front() == word; };
  if (is("--help") || is("-h")) std::cout << naiad::ctlHelp();
  if (is("--version")) std::cout << "dfctl " << naiad::kVersion << "\n";
  if (is("--markdown")) std::cout << naiad::adminMarkdown();
  if (is("--help") || is("-h") || is("--version") || is("--markdown")) return kDone;
  if (is("--option-page") && words.size() == 2) return printPage(naiad::ctlPage(words[1]));
  try {
    const naiad::CtlCommandLine line = naiad::readCtlCommandLine(words);
    if (line.words.empty()) return failUsage("A command is missing.");
    if (line.words.front() != "completion") return give(line);
    return printPage(line.words.size() == 2 ? naiad::ctlCompletion(line.words[1]) : std::nullopt);
  } catch (const naiad::AdminUsageError& error) {
    return failUsage(error.what());
  } catch (const naiad::ServerUnreachable& error) {
    std::cerr << "dfctl: " << error.what() << "\n";
    return kNoServer;
  }
}
