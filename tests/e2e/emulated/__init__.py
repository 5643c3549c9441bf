"""The real firmware behind the real program: one board and one server for all tests here."""
