"""dragonfly-adopt: builds and runs, with Naiad, a game that was written for the published Dragonfly engine."""
