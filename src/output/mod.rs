//! Files written for people and other programs: CSV, JSON, VTK and PNG.
