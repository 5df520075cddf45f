"""dragonfly-adopt: builds and runs a game for the published Dragonfly with Naiad."""
