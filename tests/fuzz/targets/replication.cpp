// A world, its publisher, a sender, a bad link and a replica, driven by a script. Whatever happens and
// whatever is lost, duplicated, reordered or damaged, the replica equals the world once the link works again.
//
//   input   when to send again 1 | steps: see ScriptedLink::run() and ScriptedWorld::happen()
#include "ScriptedLink.h"
#include "Target.h"

namespace naiad::fuzz {

void tryInput(Script script) {
  ScriptedLink link(static_cast<Resend>(script.below(3)));
  link.run(script, 200);
  link.heal(40);
  link.requireSame();
}

}  // namespace naiad::fuzz
