"""dragonfly-adopt: takes a folder with a game for the published Dragonfly, and tries to build and run it with Naiad."""
