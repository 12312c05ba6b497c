//! What sensors measure of isolated scenes, slopes and heights above the scene.
