#include "shared/options/OptionPages.h"

#include <algorithm>
#include <sstream>

#include "shared/options/Completions.h"

namespace naiad {

namespace {

constexpr std::size_t kCommentWidth = 100;

// ---- roff -------------------------------------------------------------------------------------------------

std::string roff(std::string_view text) {
  std::string escaped;
  bool begins = true;  // of a line, where . and ' are commands
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

std::string defaultOf(const Option& option) {
  if (!option.default_text.empty()) return option.default_text;
  return option.shows_default && !isFlag(option) ? currentValue(option) : "";
}

/// What stands behind the name: "=FILE", "=on|off".
std::string valueOf(const Option& option) {
  if (isFlag(option)) return {};
  std::string value;
  for (const std::string& one : option.one_of) value += (value.empty() ? "" : "|") + one;
  if (value.empty()) value = option.type;
  return value.empty() ? "VALUE" : value;
}

void writeOption(std::ostream& page, const Option& option) {
  const bool is_argument = option.name.front() != '-';
  page << ".TP\n";
  if (is_argument) {
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

/// The end of --help, paragraph by paragraph, line by line as it is there.
void writeFooter(std::ostream& page, const std::string& footer) {
  std::istringstream lines(footer);
  std::string section;
  bool begins = true;  // of a paragraph
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

// ---- the file of --config ---------------------------------------------------------------------------------

/// The text as comments of at most kCommentWidth columns.
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
  writeComment(
      page, "Settings of " + program.name +
                " (--config FILE). Each line below is what holds without it: take its # away to change it. " +
                program.name + " --config FILE --check-config says whether the file is in order.");
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
  if (option.is_secret && !value.empty()) return "# " + name + " is given, and not printed";
  const bool is_quoted = value.find_first_of("#\"' \t") != std::string::npos;
  const char quote = value.find('"') == std::string::npos ? '"' : '\'';
  if (is_quoted && value.find(quote) == std::string::npos) return name + " = " + quote + value + quote;
  return name + " =" + (value.empty() ? "" : " " + value);
}

}  // namespace naiad
