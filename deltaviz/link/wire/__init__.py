"""The messages as bytes. `protocol.toml` describes them; all that is here follows it."""
