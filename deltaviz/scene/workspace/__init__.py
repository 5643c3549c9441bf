"""The workspace in the scene: computed in processes of its own, drawn for one browser."""
