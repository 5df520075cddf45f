#include "client/ctl/CtlCommandLine.h"

#include <algorithm>
#include <cstdlib>

#include "shared/admin/AdminCommands.h"
#include "shared/admin/AdminRequest.h"
#include "shared/options/OptionPages.h"

namespace naiad {
namespace {

bool isOfCtl(const AdminCommand& command) {
  return command.isFor(AdminCommand::Level::kAdmin, AdminCommand::Frontend::kSocket);
}

std::string names() {
  std::string all = "completion";
  for (const AdminCommand& command : adminCommands()) {
    if (isOfCtl(command)) all += " " + command.name;
  }
  return all;
}

/// Returns the values of a command's first argument, if it is a choice, and its named arguments as --NAME,
/// separated by blanks.
std::string choices(const AdminCommand& command) {
  std::string all;
  if (command.arguments.empty()) return all;
  for (const std::string& one : command.arguments.front().one_of) all += (all.empty() ? "" : " ") + one;
  for (const AdminArgument& argument : command.arguments) {
    if (argument.named) all += (all.empty() ? "--" : " --") + argument.name;
  }
  return all;
}

/// Replaces colons by semicolons: zsh separates a command from its description with a colon.
std::string withoutColons(std::string text) {
  std::replace(text.begin(), text.end(), ':', ';');
  return text;
}

std::string bash() {
  std::string text =
      "# bash completion of dfctl\n"
      "_dfctl() {\n"
      "  local word=${COMP_WORDS[COMP_CWORD]} i command=\n"
      "  for ((i = 1; i < COMP_CWORD; ++i)); do\n"
      "    case ${COMP_WORDS[i]} in\n"
      "      --control) ((++i)) ;;\n"
      "      -*) ;;\n"
      "      *) command=${COMP_WORDS[i]}; break ;;\n"
      "    esac\n"
      "  done\n"
      "  if [[ ${COMP_WORDS[COMP_CWORD-1]} = --control ]]; then\n"
      "    COMPREPLY=($(compgen -f -- \"$word\"))\n"
      "    return\n"
      "  fi\n"
      "  local words=\n"
      "  case $command in\n"
      "    '') words='--control --json --help --version " +
      names() +
      "' ;;\n"
      "    completion) words='bash zsh fish' ;;\n"
      "    help) words='" +
      names() + "' ;;\n";
  for (const AdminCommand& command : adminCommands()) {
    if (isOfCtl(command) && !choices(command).empty())
      text += "    " + command.name + ") words='" + choices(command) + "' ;;\n";
  }
  return text +
         "  esac\n"
         "  COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n"
         "}\n"
         "complete -F _dfctl dfctl\n";
}

std::string zsh() {
  std::string text =
      "#compdef dfctl\n"
      "_dfctl() {\n"
      "  local -a commands=(\n";
  for (const AdminCommand& command : adminCommands()) {
    if (isOfCtl(command))
      text += "    " + inShellQuotes(command.name + ":" + withoutColons(command.help)) + "\n";
  }
  text +=
      "    'completion:Print a completion script for a shell'\n"
      "  )\n"
      "  _arguments -C '--control[Path of the server'\\''s control socket]:path:_files' '--json[Answer as "
      "JSON]' \\\n"
      "    '--help[Show help]' '--version[Show the version]' '1:command:->command' '*::argument:->argument'\n"
      "  case $state in\n"
      "    command) _describe command commands ;;\n"
      "    argument)\n"
      "      case $words[1] in\n"
      "        completion) _values shell bash zsh fish ;;\n";
  for (const AdminCommand& command : adminCommands()) {
    if (isOfCtl(command) && !choices(command).empty())
      text += "        " + command.name + ") _values argument " + choices(command) + " ;;\n";
  }
  return text +
         "      esac ;;\n"
         "  esac\n"
         "}\n"
         "if [ \"$funcstack[1]\" = _dfctl ]; then _dfctl \"$@\"; else compdef _dfctl dfctl; fi\n";
}

std::string fish() {
  std::string text =
      "# fish completion of dfctl\n"
      "complete -c dfctl -f\n"
      "complete -c dfctl -l control -r -F -d 'Path of the control socket'\n"
      "complete -c dfctl -l json -d 'Answer as JSON'\n"
      "complete -c dfctl -l help -d 'Show help'\n"
      "complete -c dfctl -l version -d 'Show the version'\n"
      "complete -c dfctl -n __fish_use_subcommand -a completion -d 'Print a completion script'\n"
      "complete -c dfctl -n '__fish_seen_subcommand_from completion' -a 'bash zsh fish'\n";
  for (const AdminCommand& command : adminCommands()) {
    if (!isOfCtl(command)) continue;
    text += "complete -c dfctl -n __fish_use_subcommand -a " + command.name + " -d " +
            inShellQuotes(command.help) + "\n";
    if (!choices(command).empty())
      text += "complete -c dfctl -n '__fish_seen_subcommand_from " + command.name + "' -a '" +
              choices(command) + "'\n";
  }
  return text;
}

const std::vector<std::string> kCtlOptions{"--control", "--json", "--help", "--version"};
constexpr std::string_view kControlOption = "--control=";

[[noreturn]] void failUnknown(const std::string& word) {
  const std::string near = suggestion(word, kCtlOptions);
  throw AdminUsageError("There is no option " + word + (near.empty() ? "." : near));
}

}  // namespace

std::optional<std::string> ctlCompletion(const std::string& shell) {
  if (shell == "bash") return bash();
  if (shell == "zsh") return zsh();
  if (shell == "fish") return fish();
  return std::nullopt;
}

std::string ctlManSections() {
  return ".SH OPTIONS\n"
         ".TP\n\\fB\\-\\-control\\fR \\fIPATH\\fR\nThe control socket; default: that of the only running "
         "server, among this user's and those in /run/naiad/admin.\n"
         ".TP\n\\fB\\-\\-json\\fR\nPrint the answer as JSON.\n"
         ".TP\n\\fB\\-\\-help\\fR, \\fB\\-\\-version\\fR\nPrint the help or the version, and exit.\n" +
         adminManSection() +
         ".SH ENVIRONMENT\n.TP\n.B NAIAD_CONTROL\nLike \\-\\-control.\n"
         ".SH EXIT STATUS\n.TP\n.B 0\nDone.\n.TP\n.B 1\nThe server refused the command.\n"
         ".TP\n.B 2\nWrong usage.\n.TP\n.B 3\nNo server answered.\n";
}

std::optional<std::string> ctlPage(const std::string& kind) {
  return kind == "man" ? ctlManSections() : ctlCompletion(kind);
}

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
      if (++next == words.size()) throw AdminUsageError("--control requires a path.");
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
      "Administer a running dfserver\n"
      "Usage: dfctl [--control PATH] [--json] COMMAND [ARGUMENT...]\n"
      "       dfctl completion bash|zsh|fish\n\n"
      "Options:\n"
      "  --control PATH  The server's control socket (or NAIAD_CONTROL); default: the only running server's\n"
      "  --json          Print the answer as JSON\n"
      "  --help          Print this and exit\n"
      "  --version       Print the version and exit\n\n"
      "Commands:\n";
  for (const std::string& one : adminHelp(AdminCommand::Level::kAdmin, AdminCommand::Frontend::kSocket))
    text += "  " + one + "\n";
  return text +
         "\nPLAYER is a name, the beginning of a name, or #ID as listed by who. SPAN is like 90 (seconds), "
         "30m, 2h or 7d;\nbefore a REASON it needs its unit.\n\n"
         "Exit codes:\n"
         "  0  done\n"
         "  1  the server refused the command\n"
         "  2  wrong usage\n"
         "  3  no server answered\n";
}

}  // namespace naiad
