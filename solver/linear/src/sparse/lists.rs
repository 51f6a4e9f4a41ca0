//! `Lists`: lists of indices one after the other.

use super::index::to_u32;

/// Lists of indices.
#[derive(Debug, Clone)]
pub(crate) struct Lists {
    /// Start of each list in the items, and the end of the last.
    starts: Vec<usize>,
    items: Vec<u32>,
}

impl Default for Lists {
    fn default() -> Self {
        Self { starts: vec![0], items: Vec::new() }
    }
}

impl Lists {
    /// Appends a list.
    pub fn push(&mut self, items: impl IntoIterator<Item = u32>) {
        self.items.extend(items);
        self.starts.push(self.items.len());
    }

    /// Appends the lists of others, one after the other.
    pub fn append(&mut self, others: &Self) {
        let before = self.items.len();
        self.starts.extend(others.starts[1..].iter().map(|start| start + before));
        self.items.extend(&others.items);
    }

    /// Number of lists.
    pub fn n(&self) -> usize {
        self.starts.len() - 1
    }

    /// A list.
    pub fn list(&self, index: usize) -> &[u32] {
        &self.items[self.starts[index]..self.starts[index + 1]]
    }

    /// Start of each list in the items, and the end of the last.
    pub fn starts(&self) -> &[usize] {
        &self.starts
    }

    /// All lists.
    pub fn iter(&self) -> impl Iterator<Item = &[u32]> {
        (0..self.n()).map(|index| self.list(index))
    }

    /// For each of n items the lists that have it, once for each time.
    pub fn inverted(&self, n: usize) -> Self {
        let starts = starts_by_item(&self.items, n);
        let mut next = starts.clone();
        let mut items = vec![0; self.items.len()];
        for (index, list) in self.iter().enumerate() {
            for &item in list {
                items[next[item as usize]] = to_u32(index);
                next[item as usize] += 1;
            }
        }
        Self { starts, items }
    }

    /// Starts and items.
    pub fn into_parts(self) -> Parts {
        Parts { starts: self.starts, items: self.items }
    }
}

/// Where the entries of each of n items start when entries are ordered by item, and the end of the last.
pub(crate) fn starts_by_item(items: &[u32], n: usize) -> Vec<usize> {
    let mut starts = vec![0; n + 1];
    for &item in items {
        starts[item as usize + 1] += 1;
    }
    for item in 0..n {
        starts[item + 1] += starts[item];
    }
    starts
}

/// What lists are made of.
pub(crate) struct Parts {
    /// Start of each list in the items, and the end of the last.
    pub starts: Vec<usize>,
    /// The items of all lists.
    pub items: Vec<u32>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverted_lists_have_the_lists_of_each_item() {
        let mut lists = Lists::default();
        lists.push([2, 0]);
        let mut others = Lists::default();
        others.push([]);
        others.push([2, 2]);
        lists.append(&others);
        assert_eq!(lists.n(), 3);
        let inverted = lists.inverted(3);
        assert!(inverted.iter().eq([&[0][..], &[], &[0, 2, 2]]));
    }
}
