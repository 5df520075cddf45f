// Chooses the files, variables and memory that the worlds of a server get (host/world/Sandbox.h).
//
// A game reads its own folder and those of its resources, and writes into the working directory. A folder
// that is too wide (the user's home, or one that holds the server's key) is not given as a whole: of it a
// game gets sprites/ and sounds/.
#pragma once

#include <string>
#include <vector>

#include "host/settings/HostOptions.h"
#include "host/world/Sandbox.h"

namespace naiad {

/// Places of a game and its files. Relative paths begin in the directory of the program's start.
struct GamePaths {
  std::vector<std::string> files;         ///< its module, its settings
  std::vector<std::string> folders;       ///< its resources
  std::vector<std::string> logs;          ///< files that it appends to
  std::vector<std::string> server_files;  ///< written by the server: no world should write them
  std::vector<std::string> secrets;       ///< files or folders, in addition to those of the options
  bool is_program = false;  ///< the front's program is the game itself: a world may write into its folder
};

struct SandboxPolicy {
  Sandbox sandbox;
  std::vector<std::string> notes;  ///< lines for the log: what a game may lack
};

SandboxPolicy makeSandboxPolicy(const HostOptions& options, const GamePaths& place);

/// Returns the variables that a world gets from this process's environment: a fixed choice, and those that
/// HostOptions::world_environment names. Never the passwords.
std::vector<std::string> makeWorldEnvironment(const HostOptions& options);

/// Like makeWorldEnvironment(), for worlds whose rounds are recorded: variables that depend on the user who
/// started the server are removed or fixed, unless the options name them.
std::vector<std::string> makeFixedEnvironment(const HostOptions& options);

/// True for "NAME=value" of a variable that changes the engine's behaviour, and that a round's file has.
bool isGameVariable(const std::string& entry);

/// Overwrites the values of --password and --admin-password, because every process of this machine can read a
/// command line.
void hidePassword(int argc, char** argv);
/// Returns the words of a command line without its passwords, for a program that this one runs.
std::vector<std::string> withoutPasswords(const std::vector<std::string>& words);

/// Returns the file of --config; empty if there is none.
std::string configFileOf(int argc, const char* const* argv);

}  // namespace naiad
