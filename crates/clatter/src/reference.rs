//! Eqs. 1 to 3 of the paper as they are printed: the plain reference that the fast ways are tested against.
