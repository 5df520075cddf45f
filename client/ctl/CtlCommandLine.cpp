#include "client/ctl/CtlCommandLine.h"

#include <cstdlib>

#include "shared/admin/AdminCommands.h"
#include "shared/admin/AdminRequest.h"
#include "shared/options/NearestName.h"

namespace naiad {

namespace {

const std::vector<std::string> kCtlOptions{"--control", "--json", "--help", "--version"};
constexpr std::string_view kControlOption = "--control=";

[[noreturn]] void failUnknown(const std::string& word) {
  const std::string near = nearestName(word, kCtlOptions);
  throw AdminUsageError("There is no option " + word + (near.empty() ? "." : "; did you mean " + near + "?"));
}

}  // namespace

CtlCommandLine readCtlCommandLine(const std::vector<std::string>& words) {
  CtlCommandLine line;
  if (const char* p_control = std::getenv("NAIAD_CONTROL")) line.control = p_control;
  std::size_t next = 0;
  for (; next < words.size() && words[next].starts_with("-"); ++next) {
    const std::string& word = words[next];
    if (word == "--json") {
      line.json = true;
    } else if (word.starts_with(kControlOption)) {
      line.control = word.substr(kControlOption.size());
    } else if (word == "--control") {
      if (++next == words.size()) throw AdminUsageError("--control wants a path.");
      line.control = words[next];
    } else {
      failUnknown(word);
    }
  }
  line.words.assign(words.begin() + static_cast<std::ptrdiff_t>(next), words.end());
  if (line.words.size() > 1 && line.words.back() == "--json") {
    line.json = true;
    line.words.pop_back();
  }
  return line;
}

std::string ctlHelp() {
  std::string text =
      "Look after a running dfserver\n"
      "Usage: dfctl [--control PATH] [--json] COMMAND [ARGUMENT...]\n"
      "       dfctl completion bash|zsh|fish\n\n"
      "Options:\n"
      "  --control PATH  The server's control socket (or NAIAD_CONTROL); default: that of the one server "
      "there is\n"
      "  --json          Print the answer as JSON\n"
      "  --help          Print this and exit\n"
      "  --version       Print the version and exit\n\n"
      "Commands:\n";
  for (const std::string& one : adminHelp(AdminCommand::Level::kAdmin, AdminCommand::Place::kSocket))
    text += "  " + one + "\n";
  return text +
         "\nPLAYER is a name, its beginning, or #ID as who lists it. SPAN is like 90s, 30m, 2h or 7d.\n\n"
         "Exit codes:\n"
         "  0  done\n"
         "  1  the server refuses\n"
         "  2  wrong usage\n"
         "  3  no server answers\n";
}

}  // namespace naiad
