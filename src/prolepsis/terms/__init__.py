"""Terms, intervals, units and errors: what every room speaks, and what knows no other room."""
