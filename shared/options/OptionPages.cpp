#include "shared/options/OptionPages.h"

#include <algorithm>
#include <sstream>

namespace naiad {

std::string inShellQuotes(std::string_view text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

std::string roff(std::string_view text) {
  std::string escaped;
  bool begins = true;  // at the beginning of a line, where . and ' start a command
  for (const char c : text) {
    if (begins && (c == '.' || c == '\'')) escaped += "\\&";
    if (c == '\\') {
      escaped += "\\e";
    } else if (c == '-') {
      escaped += "\\-";
    } else {
      escaped += c;
    }
    begins = c == '\n';
  }
  return escaped;
}

namespace {

/// True if the option takes no value.
bool isFlag(const Option& option) {
  return std::holds_alternative<bool*>(option.target);
}

bool isArgument(const Option& option) {
  return option.name.front() != '-';
}

bool isFile(const Option& option) {
  return option.type == "FILE" || option.type == "DIR" || option.type == "SOCKET";
}

/// Returns the possible values of the option, separated by blanks; empty if any value is possible.
std::string wordsOf(const Option& option) {
  std::string words;
  for (const std::string& one : option.one_of) words += (words.empty() ? "" : " ") + one;
  if (!words.empty() || option.type.find('|') == std::string::npos) return words;
  words = option.type;
  std::replace(words.begin(), words.end(), '|', ' ');
  return words;
}

/// Returns `text` with a backslash before each of `specials`.
std::string escaped(std::string_view text, std::string_view specials) {
  std::string result;
  for (const char c : text) {
    if (specials.find(c) != std::string_view::npos) result += '\\';
    result += c;
  }
  return result;
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

/// Returns the option's specification for zsh's _arguments.
std::string zshSpecification(const Option& option) {
  const std::string what = "[" + escaped(option.help, "[]:\\") + "]";
  if (isFlag(option)) return option.name + what;
  std::string action = ": ";
  if (isFile(option)) action = ":_files";
  if (const std::string words = wordsOf(option); !words.empty()) action = ":(" + words + ")";
  const std::string value = escaped(option.type.empty() ? "value" : option.type, ":");
  return option.name + "=" + what + ":" + value + action;
}

constexpr std::size_t kCommentWidth = 100;

/// Returns the options that --help shows, in its order, with --help, --version and --config first.
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

// Shell completions: names of options, values from a list of words, and files.

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

// ---- the man page -----------------------------------------------------------------------------------------

std::string defaultOf(const Option& option) {
  if (!option.default_text.empty()) return option.default_text;
  return option.shows_default && !isFlag(option) ? currentValue(option) : "";
}

/// Returns the value's placeholder: "FILE", "on|off"; empty for a flag.
std::string valueOf(const Option& option) {
  if (isFlag(option)) return {};
  std::string value;
  for (const std::string& one : option.one_of) value += (value.empty() ? "" : "|") + one;
  if (value.empty()) value = option.type;
  return value.empty() ? "VALUE" : value;
}

void writeOption(std::ostream& page, const Option& option) {
  page << ".TP\n";
  if (isArgument(option)) {
    page << "\\fI" << roff(valueOf(option)) << "\\fR\n";
  } else if (isFlag(option)) {
    page << "\\fB" << roff(option.name) << "\\fR\n";
  } else {
    page << "\\fB" << roff(option.name) << "\\fR=\\fI" << roff(valueOf(option)) << "\\fR\n";
  }
  page << roff(option.help) << ".";
  if (const std::string text = defaultOf(option); !text.empty()) page << " Default: " << roff(text) << ".";
  if (!option.environment.empty()) page << " Variable: \\fB" << option.environment << "\\fR.";
  page << "\n";
}

/// Writes the end of --help, paragraph by paragraph, and keeps its line breaks.
void writeFooter(std::ostream& page, const std::string& footer) {
  std::istringstream lines(footer);
  std::string section;
  bool begins = true;  // at the beginning of a paragraph
  for (std::string line; std::getline(lines, line);) {
    if (line.empty()) {
      begins = true;
      continue;
    }
    if (begins) {
      const std::string wanted = line.starts_with("Exit codes:") ? "EXIT STATUS" : "NOTES";
      if (!section.empty()) page << ".fi\n";
      page << (section == wanted ? ".PP\n" : ".SH " + wanted + "\n") << ".nf\n";
      section = wanted;
    }
    begins = false;
    page << roff(line) << "\n";
  }
  if (!section.empty()) page << ".fi\n";
}

std::string manPage(const Program& program, const std::vector<Option>& options) {
  std::ostringstream page;
  page << ".SH OPTIONS\n";
  for (const Option& option : shownOptions(program, options)) writeOption(page, option);
  writeFooter(page, program.footer);
  return page.str();
}

std::string settingsPage(const std::vector<Option>& options) {
  std::ostringstream page;
  for (const Option& option : options) {
    if (!isSetting(option)) continue;
    page << ".TP\n\\fB" << roff(option.name.substr(2)) << "\\fR = \\fI"
         << roff(isFlag(option) ? "true|false" : valueOf(option)) << "\\fR\n"
         << roff(option.help) << ".";
    if (const std::string text = currentValue(option); !text.empty())
      page << " Default: " << roff(text) << ".";
    page << "\n";
  }
  return page.str();
}

// ---- the --config file ------------------------------------------------------------------------------------

/// Writes the text as comment lines of at most kCommentWidth columns.
void writeComment(std::ostream& page, const std::string& text) {
  std::istringstream words(text);
  std::string line = "#";
  for (std::string word; words >> word;) {
    if (line.size() + 1 + word.size() > kCommentWidth) {
      page << line << "\n";
      line = "#";
    }
    line += " " + word;
  }
  page << line << "\n";
}

std::string exampleConfig(const Program& program, const std::vector<Option>& options) {
  std::ostringstream page;
  writeComment(page,
               "Settings of " + program.name +
                   " (--config FILE). Each line below shows a default value: remove its # to change it. " +
                   program.name + " --config FILE --check-config checks the file.");
  for (const Option& option : options) {
    if (!isSetting(option)) continue;
    page << "\n";
    writeComment(page, option.help);
    page << "#" << configLine(option) << "\n";
  }
  return page.str();
}

}  // namespace

std::optional<std::string> optionPage(std::string_view kind, const Program& program,
                                      const std::vector<Option>& options) {
  if (kind == "man") return manPage(program, options);
  if (kind == "bash") return bashCompletion(program, options);
  if (kind == "zsh") return zshCompletion(program, options);
  if (kind == "fish") return fishCompletion(program, options);
  if (kind == "settings") return settingsPage(options);
  if (kind == "config") return exampleConfig(program, options);
  return std::nullopt;
}

bool isSetting(const Option& option) {
  return option.name.starts_with("--") && !option.environment.empty() && !option.hidden;
}

std::string configLine(const Option& option) {
  const std::string name = option.name.substr(2);
  const std::string value = currentValue(option);
  if (option.is_secret && !value.empty()) return "# " + name + " is set, but not printed";
  const bool is_quoted = value.find_first_of("#\"' \t") != std::string::npos;
  const char quote = value.find('"') == std::string::npos ? '"' : '\'';
  if (is_quoted && value.find(quote) == std::string::npos) return name + " = " + quote + value + quote;
  return name + " =" + (value.empty() ? "" : " " + value);
}

}  // namespace naiad
