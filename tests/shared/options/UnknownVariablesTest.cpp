#include <gtest/gtest.h>

#include "shared/options/Options.h"

namespace naiad {
namespace {

TEST(UnknownVariables, AreReportedWithTheNearestName) {
  const char* const environment[] = {"PATH=/bin",   "NAIAD_PORT=1",  "NAIAD_PROT=1", "NAIAD_SOMETHING_ELSE=",
                                     "NAIAD_LOG=x", "XNAIAD_PROT=1", nullptr};
  EXPECT_EQ(unknownVariableWarnings(environment, "NAIAD_", {"NAIAD_PORT", "NAIAD_LOG"}),
            (std::vector<std::string>{"there is no variable NAIAD_PROT; did you mean NAIAD_PORT?",
                                      "there is no variable NAIAD_SOMETHING_ELSE"}));
}

}  // namespace
}  // namespace naiad
