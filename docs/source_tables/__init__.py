"""The tables of sources.md and kinematics.md: what the sources say, beside what we compute."""
