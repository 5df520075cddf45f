#include "shared/options/Completions.h"

#include <algorithm>
#include <sstream>
#include <string_view>

namespace naiad {

namespace {

bool isArgument(const Option& option) {
  return option.name.front() != '-';
}

bool isFile(const Option& option) {
  return option.type == "FILE" || option.type == "DIR" || option.type == "SOCKET";
}

/// The words that its value may be, with blanks between; empty: anything.
std::string wordsOf(const Option& option) {
  std::string words;
  for (const std::string& one : option.one_of) words += (words.empty() ? "" : " ") + one;
  if (!words.empty() || option.type.find('|') == std::string::npos) return words;
  words = option.type;
  std::replace(words.begin(), words.end(), '|', ' ');
  return words;
}

/// `text` with a backslash before each of `specials`.
std::string escaped(std::string_view text, std::string_view specials) {
  std::string result;
  for (const char c : text) {
    if (specials.find(c) != std::string_view::npos) result += '\\';
    result += c;
  }
  return result;
}

/// In single quotes for a shell of Bourne's kind.
std::string inShellQuotes(std::string_view text) {
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'') {
      quoted += "'\\''";
    } else {
      quoted += c;
    }
  }
  return quoted + "'";
}

std::string functionName(const Program& program) {
  std::string name = "_" + program.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

const char* const kBashBegin = R"(  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]}
  # --name=value is three words here.
  if [[ $word == "=" ]]; then
    word=""
  elif [[ $before == "=" && COMP_CWORD -ge 2 ]]; then
    before=${COMP_WORDS[COMP_CWORD - 2]}
  fi
  COMPREPLY=()
  case $before in
)";

/// One of zsh's specifications.
std::string zshSpecification(const Option& option) {
  const std::string what = "[" + escaped(option.help, "[]:\\") + "]";
  if (isFlag(option)) return option.name + what;
  std::string action = ": ";
  if (isFile(option)) action = ":_files";
  if (const std::string words = wordsOf(option); !words.empty()) action = ":(" + words + ")";
  const std::string value = escaped(option.type.empty() ? "value" : option.type, ":");
  return option.name + "=" + what + ":" + value + action;
}

}  // namespace

bool isFlag(const Option& option) {
  return std::holds_alternative<bool*>(option.target);
}

std::vector<Option> shownOptions(const Program& program, const std::vector<Option>& options) {
  static bool flag = false;
  static std::string text;
  std::vector<Option> shown{{"--help", &flag, "Print this help, and exit"},
                            {"--version", &flag, "Print the version, and exit"}};
  if (program.has_config) {
    shown.push_back({"--config", &text, kConfigHelp});
    shown.back().type = "FILE";
  }
  std::copy_if(options.begin(), options.end(), std::back_inserter(shown),
               [](const Option& option) { return !option.hidden; });
  return shown;
}

std::string bashCompletion(const Program& program, const std::vector<Option>& options) {
  std::ostringstream file;
  std::string names;
  std::string files;
  std::string values;
  file << "# bash completion for " << program.name << ", made from its options.\n"
       << functionName(program) << "() {\n"
       << kBashBegin;
  for (const Option& option : shownOptions(program, options)) {
    if (isArgument(option)) continue;
    names += (names.empty() ? "" : " ") + option.name;
    if (isFlag(option)) continue;
    if (const std::string words = wordsOf(option); !words.empty()) {
      file << "    " << option.name << ") mapfile -t COMPREPLY < <(compgen -W '" << words
           << "' -- \"$word\"); return ;;\n";
    } else {
      std::string& list = isFile(option) ? files : values;
      list += (list.empty() ? "" : " | ") + option.name;
    }
  }
  if (!files.empty())
    file << "    " << files
         << ")\n      compopt -o filenames\n      mapfile -t COMPREPLY < <(compgen -f -- \"$word\")\n      "
            "return ;;\n";
  if (!values.empty()) file << "    " << values << ") return ;;\n";
  file << "  esac\n  mapfile -t COMPREPLY < <(compgen -W '" << names << "' -- \"$word\")\n}\n"
       << "complete -F " << functionName(program) << " " << program.name << "\n";
  return file.str();
}

std::string zshCompletion(const Program& program, const std::vector<Option>& options) {
  std::ostringstream file;
  file << "#compdef " << program.name << "\n# Made from the options of " << program.name << ".\n_arguments";
  for (const Option& option : shownOptions(program, options)) {
    const std::string specification =
        isArgument(option) ? ":" + escaped(option.help, ":\\") + ": " : zshSpecification(option);
    file << " \\\n  " << inShellQuotes(specification);
  }
  file << "\n";
  return file.str();
}

std::string fishCompletion(const Program& program, const std::vector<Option>& options) {
  std::ostringstream file;
  file << "# Made from the options of " << program.name << ".\ncomplete -c " << program.name << " -f\n";
  for (const Option& option : shownOptions(program, options)) {
    if (isArgument(option)) continue;
    file << "complete -c " << program.name << " -l " << option.name.substr(2);
    if (const std::string words = wordsOf(option); !words.empty()) {
      file << " -x -a '" << words << "'";
    } else if (isFile(option)) {
      file << " -r -F";
    } else if (!isFlag(option)) {
      file << " -x";
    }
    file << " -d '" << escaped(option.help, "'\\") << "'\n";
  }
  return file.str();
}

}  // namespace naiad
