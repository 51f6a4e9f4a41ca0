//! Nodes and elements of files of the versions 2.2 and 4.0, whose tags have 32 bits.

use std::collections::HashSet;

use super::error::MshError;
use super::file::{Block, MshFile, dimension, kind_of, n_blocks_and_things};
use super::input::Input;
use super::kind::Kind;
use crate::Point;

impl MshFile {
    /// Nodes of version 4.0: each behind its tag.
    pub(super) fn read_nodes_with_tags(&mut self, input: &mut Input<'_>) -> Result<(), MshError> {
        let n_blocks = n_blocks_and_things(input, "nodes", 8)?;
        for _ in 0..n_blocks {
            input.integer()?;
            let dimension = dimension(input)?;
            let is_parametric = input.integer()? != 0;
            for _ in 0..input.count("nodes", 8)? {
                let tag = input.tag()?;
                let point = Point::<3>::new(input.float()?, input.float()?, input.float()?);
                for _ in 0..if is_parametric { dimension } else { 0 } {
                    input.float()?;
                }
                self.add_node(input, tag, point)?;
            }
        }
        Ok(())
    }

    /// Nodes of version 2.2, in one list.
    pub(super) fn read_listed_nodes(&mut self, input: &mut Input<'_>) -> Result<(), MshError> {
        for _ in 0..input.count_in_line("nodes", 7)? {
            let tag = input.tag()?;
            let point = Point::<3>::new(input.float()?, input.float()?, input.float()?);
            self.add_node(input, tag, point)?;
        }
        Ok(())
    }

    /// Elements of version 2.2, in one list. Each says its physical group, which stands for its entity here; one that
    /// is in several groups is there several times, and kept once a group, cells once.
    pub(super) fn read_listed_elements(&mut self, input: &mut Input<'_>) -> Result<(), MshError> {
        let mut left = input.count_in_line("elements", 4)?;
        let mut cells = HashSet::new();
        while left > 0 {
            let listed = ListedElements::read(input)?;
            // Only binary files have several elements behind one head
            let n = if input.is_binary() { listed.n_elements } else { 1 };
            if n == 0 || n > left {
                let found = format!("{n} elements, but {left} are left");
                return Err(input.refuse(found, "the file is damaged or cut off"));
            }
            for _ in 0..n {
                self.read_listed_element(input, &listed, &mut cells)?;
            }
            left -= n;
        }
        Ok(())
    }

    fn read_listed_element(
        &mut self,
        input: &mut Input<'_>,
        listed: &ListedElements,
        cells: &mut HashSet<Vec<u64>>,
    ) -> Result<(), MshError> {
        let (tag, n_tags) = match listed.text_tag {
            Some(tag) => (tag, listed.n_tags),
            None => (input.tag()?, listed.n_tags),
        };
        let mut group = 0;
        for nth in 0..n_tags {
            let number = input.integer()?;
            if nth == 0 {
                group = number.saturating_abs();
            }
        }
        let kind = listed.kind;
        let mut nodes = Vec::with_capacity(kind.n_nodes);
        for _ in 0..kind.n_nodes {
            nodes.push(self.read_node_of_element(input, true)?);
        }
        if group != 0 {
            self.groups[kind.dimension].entry(group).or_insert_with(|| vec![group]);
        }
        if kind.dimension >= 2 && !cells.insert(nodes.clone()) && group == 0 {
            return Ok(());
        }
        match self.blocks.last_mut() {
            Some(last) if last.kind == kind && last.entity == group => {
                last.tags.push(tag);
                last.nodes.append(&mut nodes);
            }
            _ => self.blocks.push(Block { kind, entity: group, tags: vec![tag], nodes }),
        }
        Ok(())
    }
}

/// What stands before elements.
struct ListedElements {
    kind: Kind,
    n_elements: usize,
    n_tags: usize,
    /// Of one element in text, which stands first.
    text_tag: Option<u64>,
}

impl ListedElements {
    fn read(input: &mut Input<'_>) -> Result<Self, MshError> {
        if input.is_binary() {
            let kind = kind_of(input)?;
            let n_elements = input.small("elements")?;
            let n_tags = input.small("tags")?;
            return Ok(Self { kind, n_elements, n_tags, text_tag: None });
        }
        let tag = input.tag()?;
        let kind = kind_of(input)?;
        let n_tags = input.small("tags")?;
        Ok(Self { kind, n_elements: 1, n_tags, text_tag: Some(tag) })
    }
}
