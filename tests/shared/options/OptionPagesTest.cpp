// Man pages, completions and the example configuration are made from the table of options. They contain all
// options, and no help text can break their format.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "shared/options/OptionPages.h"
#include "tests/support/TempFolder.h"
#include "tests/support/Text.h"

namespace naiad {
namespace {

class OptionPagesTest : public testing::Test {
 protected:
  OptionPagesTest() {
    options = {
        {.name = "server", .target = &server, .help = "Where it is", .type = "SERVER"},
        {.name = "--port",
         .target = &port,
         .help = "Port: 'any' [free] one\\way",
         .environment = "THING_PORT",
         .range = OptionRange{0, 65535},
         .shows_default = true},
        {.name = "--players",
         .target = &players,
         .help = "Who plays",
         .environment = "THING_PLAYERS",
         .one_of = {"together", "first"},
         .shows_default = true},
        {.name = "--log", .target = &log, .help = ".A file", .environment = "THING_LOG", .type = "FILE"},
        {.name = "--password",
         .target = &password,
         .help = "A word",
         .environment = "THING_PASSWORD",
         .is_secret = true},
        {.name = "--qr", .target = &qr, .help = "A flag", .environment = "THING_QR"},
        {.name = "--list", .target = &list, .help = "Print, and exit"},
        {.name = "--inner", .target = &list, .help = "Not for people", .hidden = true}};
  }
  std::string page(const std::string& kind) const {
    return optionPage(kind, program, options).value_or("none");
  }
  /// Returns the lines that begin with `begin`.
  static std::vector<std::string> linesWith(const std::string& text, const std::string& begin) {
    std::vector<std::string> found;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with(begin)) found.push_back(line);
    }
    return found;
  }

  const Program program{"dfthing", "Does a thing.", "A note.\n\nExit codes:\n  0  well\n", true};
  std::vector<Option> options;
  std::string server;
  int port = 7;
  std::string players = "together";
  std::string log;
  std::string password;
  bool qr = false;
  bool list = false;
};

TEST_F(OptionPagesTest, EachShownOptionIsInEachPage) {
  for (const char* kind : {"man", "bash", "zsh", "fish"}) {
    const std::string text = page(kind);
    for (const std::string name :
         {"help", "version", "config", "port", "players", "log", "password", "qr", "list"}) {
      const bool is_there =
          text.find((kind == std::string("fish") ? "-l " : "--") + name) != std::string::npos ||
          text.find("\\-\\-" + name) != std::string::npos;
      EXPECT_TRUE(is_there) << kind << ": " << name;
    }
    EXPECT_EQ(text.find("inner"), std::string::npos) << kind;
  }
  EXPECT_EQ(page("pdf"), "none");
}

TEST_F(OptionPagesTest, ManPageHasDefaultsVariablesAndNotes) {
  const std::string text = page("man");
  EXPECT_NE(text.find(".TP\n\\fB\\-\\-port\\fR=\\fIVALUE\\fR\n"
                      "Port: 'any' [free] one\\eway. Default: 7. Variable: \\fBTHING_PORT\\fR.\n"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("\n\\&.A file."), std::string::npos) << "a line that begins with a dot is a command";
  EXPECT_NE(text.find(".TP\n\\fISERVER\\fR\nWhere it is.\n"), std::string::npos) << text;
  EXPECT_NE(text.find(".SH NOTES\n.nf\nA note.\n.fi\n.SH EXIT STATUS\n.nf\nExit codes:\n  0  well\n.fi\n"),
            std::string::npos)
      << text;
}

TEST_F(OptionPagesTest, CompletionsOfferWordsAndFiles) {
  EXPECT_NE(
      page("bash").find("--players) mapfile -t COMPREPLY < <(compgen -W 'together first' -- \"$word\")"),
      std::string::npos);
  EXPECT_NE(page("bash").find("--config | --log)\n      compopt -o filenames"), std::string::npos)
      << page("bash");
  EXPECT_NE(page("zsh").find("'--players=[Who plays]:value:(together first)'"), std::string::npos);
  EXPECT_NE(page("zsh").find("'--port=[Port\\: '\\''any'\\'' \\[free\\] one\\\\way]:value: '"),
            std::string::npos)
      << page("zsh");
  EXPECT_NE(page("fish").find("-l port -x -d 'Port: \\'any\\' [free] one\\\\way'"), std::string::npos)
      << page("fish");
}

// Runs the completion in the real bash.
TEST_F(OptionPagesTest, BashRunsTheCompletion) {
  const test::TempFolder base;
  std::ofstream(base / "completion") << page("bash");
  std::ofstream(base / "try")
      << "set -eu; source \"$1/completion\"\n"
         "ask() { COMP_WORDS=(\"$@\"); COMP_CWORD=$(($# - 1)); _dfthing; echo \"${COMPREPLY[*]}\"; }\n"
         "ask dfthing --p; ask dfthing --players fi; ask dfthing --players = t; ask dfthing --players =\n"
         "ask dfthing --port 1; ask dfthing --inn\n";
  const std::string command =
      "bash " + (base / "try").string() + " " + base.string() + " >" + (base / "said").string();
  EXPECT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(test::contentOf(base / "said"),
            "--port --players --password\nfirst\ntogether\ntogether first\n\n\n");
}

TEST_F(OptionPagesTest, ExampleConfigListsTheDefaults) {
  const std::string text = page("config");
  EXPECT_EQ(linesWith(text, "#port"), std::vector<std::string>{"#port = 7"});
  EXPECT_EQ(linesWith(text, "#password"), std::vector<std::string>{"#password ="});
  EXPECT_EQ(linesWith(text, "#qr"), std::vector<std::string>{"#qr = false"});
  EXPECT_EQ(text.find("#list"), std::string::npos) << "what has no variable is no setting";
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    EXPECT_TRUE(line.empty() || line.front() == '#') << line;
    EXPECT_LE(line.size(), 100u) << line;
  }
}

TEST_F(OptionPagesTest, ConfigLineIsQuotedWhereNeeded) {
  log = "/tmp/a b";
  EXPECT_EQ(configLine(options[3]), "log = \"/tmp/a b\"");
  log = "a\"#b";
  EXPECT_EQ(configLine(options[3]), "log = 'a\"#b'");
  password = "secret";
  EXPECT_EQ(configLine(options[4]), "# password is set, but not printed");
}

}  // namespace
}  // namespace naiad
