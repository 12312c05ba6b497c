//! Values of products by randomisation.

use super::Product;

impl Product {
    /// Adds the values of the next randomisation, from the same product of that randomisation alone.
    ///
    /// # Panics
    /// If it is another product.
    pub fn add_replicate(&mut self, one: &Self) {
        assert_eq!((&self.name, self.values.len()), (&one.name, one.values.len()), "one product");
        self.replicates.extend_from_slice(&one.values);
    }
}
