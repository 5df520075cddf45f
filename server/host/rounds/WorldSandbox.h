// Which files, variables and how much memory the worlds of a server get (host/world/Sandbox.h).
//
// A game reads the folders that it lies in and that its files are looked for in, and writes into the working
// directory. A folder that is too wide - the user's home, or one that holds the server's key - is not given
// as a whole: of it a game gets what is in sprites/ and sounds/.
#pragma once

#include <string>
#include <vector>

#include "host/settings/HostOptions.h"
#include "host/world/Sandbox.h"

namespace naiad {

/// Where a game and its files are. Relative paths begin in the directory of the program's start.
struct GamePlace {
  std::vector<std::string> files;         ///< its module, its settings
  std::vector<std::string> folders;       ///< its resources
  std::vector<std::string> logs;          ///< that it appends to
  std::vector<std::string> server_files;  ///< that the server writes: no world should
  std::vector<std::string> secrets;       ///< beside those that the options name: files or folders
  bool is_program = false;  ///< the front's program is the game itself: not kept from being written
};

struct WorldSandbox {
  Sandbox sandbox;
  std::vector<std::string> notes;  ///< for the log: what a game might miss
};

WorldSandbox makeWorldSandbox(const HostOptions& options, const GamePlace& place);

/// What a world has of this process's environment: a fixed choice, and what HostOptions::world_environment
/// names. Never the password.
std::vector<std::string> makeWorldEnvironment(const HostOptions& options);

/// The same for worlds whose rounds are written down: what depends on who has started the server is left out
/// or fixed, beyond those variables.
std::vector<std::string> makeFixedEnvironment(const HostOptions& options);

/// "NAME=value": a variable by which the engine itself is another one for the game, and which a round's file
/// keeps.
bool isGameVariable(const std::string& entry);

/// Overwrite the values of --password and --admin-password, which every process of this machine can read in a
/// command line.
void hidePassword(int argc, char** argv);
/// The words of a command line without its passwords: for a program that is run beside this one.
std::vector<std::string> withoutPasswords(const std::vector<std::string>& words);

/// The file of --config; empty if there is none.
std::string configFileOf(int argc, const char* const* argv);

}  // namespace naiad
