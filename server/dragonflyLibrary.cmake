# The target dragonfly::dragonfly: the engine's library, and the physics library if the game uses bodies.
if(NOT TARGET dragonfly::dragonfly)
  add_library(dragonfly::dragonfly INTERFACE IMPORTED)
  set_target_properties(dragonfly::dragonfly PROPERTIES INTERFACE_LINK_LIBRARIES
    "dragonfly::engine;-Wl,--push-state,--as-needed;dragonfly::physics;-Wl,--pop-state")
endif()
