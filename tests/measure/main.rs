//! Measures of made coils whose gaps, heights and places are known beforehand.

mod bowed;
mod changes;
mod coils;
mod crossovers;
mod defects;
mod empty_place;
mod layers;
mod on_flats;
mod pitch;
mod product;
mod shop_floor;
mod squeezed;
