#include <gtest/gtest.h>

#include "client/ctl/CtlCommandLine.h"
#include "shared/admin/AdminCommands.h"
#include "shared/admin/AdminRequest.h"
#include "tests/support/Text.h"

namespace naiad {
namespace {

using Words = std::vector<std::string>;

TEST(CtlCommandLine, OptionsPrecedeTheCommand) {
  const CtlCommandLine line = readCtlCommandLine({"--control", "/run/x", "--json", "restart", "--in", "60s"});
  EXPECT_EQ(line.control, "/run/x");
  EXPECT_TRUE(line.json);
  EXPECT_EQ(line.words, (Words{"restart", "--in", "60s"}));
  EXPECT_EQ(readCtlCommandLine({"--control=/run/y", "who"}).control, "/run/y");
}

TEST(CtlCommandLine, JsonMayBeTheLastWord) {
  const CtlCommandLine line = readCtlCommandLine({"who", "--json"});
  EXPECT_TRUE(line.json);
  EXPECT_EQ(line.words, (Words{"who"}));
  EXPECT_EQ(readCtlCommandLine({"say", "--json", "is", "nice"}).words.size(), 4u);
}

TEST(CtlCommandLine, UnknownOptionErrorSuggestsTheNearest) {
  EXPECT_EQ(test::errorOf<AdminUsageError>([] {
              readCtlCommandLine({"--jsn", "who"});
            }),
            "There is no option --jsn; did you mean --json?");
  EXPECT_THROW(readCtlCommandLine({"--control"}), AdminUsageError);
}

TEST(CtlCommandLine, HelpCompletionsAndManualHaveEveryCommand) {
  const std::string help = ctlHelp();
  const std::string manual = ctlManSections();
  for (const AdminCommand& command : adminCommands()) {
    const bool here = command.isFor(AdminCommand::Level::kAdmin, AdminCommand::Frontend::kSocket);
    EXPECT_EQ(help.find("\n  " + command.name) != std::string::npos, here) << command.name;
    for (const char* shell : {"bash", "zsh", "fish"})
      EXPECT_TRUE(!here || ctlCompletion(shell)->find(command.name) != std::string::npos) << command.name;
    EXPECT_TRUE(!here || manual.find(".B " + command.name) != std::string::npos) << command.name;
  }
  EXPECT_FALSE(ctlCompletion("csh"));
}

}  // namespace
}  // namespace naiad
