"""Flies a user's own fleet through a scenario: ../README.md."""
