//! Gap, overlap and bulge of the settled turns, and the verdict drawn from them.
