// Assertions on how a program on a scripted terminal ended.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include "PtyTerminal.h"

namespace naiad::test {

/// True if the program exits with this code within a minute.
inline testing::AssertionResult exits(PtyTerminal& program, int code) {
  const int status = program.waitForExit();
  if (WIFEXITED(status) && WEXITSTATUS(status) == code) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "wait status " << status << ": " << program.output();
}

/// True if this signal ends the program within a minute.
inline testing::AssertionResult diesOf(PtyTerminal& program, int signal) {
  const int status = program.waitForExit();
  if (WIFSIGNALED(status) && WTERMSIG(status) == signal) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "wait status " << status << ": " << program.output();
}

}  // namespace naiad::test
