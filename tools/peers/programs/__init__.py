"""Programs of the comparison. Each measures "image" and "directions" of a scene and says how long that took."""
