//! The answers of searches with their costs, for a judge that does not trust them.

use super::{Answer, CellsAnswer, GraphAnswer, PacketAnswer, SearchAnswer, ShadeAnswer, WideAnswer};

/// The answer to one query whose cost is counted.
pub enum Costs<'a> {
    /// Of a search in a hierarchy.
    Search(&'a mut SearchAnswer),
    /// Of a search in a scene graph.
    Graph(&'a mut GraphAnswer),
    /// Of a search in cells or half-spaces.
    Cells(&'a mut CellsAnswer),
    /// Of a packet of rays.
    Packet(&'a mut PacketAnswer),
    /// Of shading, which costs shadow rays.
    Shade(&'a mut ShadeAnswer),
    /// Of a search in a wide tree.
    Wide(&'a mut WideAnswer),
}

impl Answer {
    /// Returns the answers with counted costs, in the order of their queries; none if the request counts nothing.
    pub fn costs(&mut self) -> Vec<Costs<'_>> {
        match self {
            Answer::BruteForce(answers) | Answer::ClosestHitBoth(answers) | Answer::ClosestHit(answers) => {
                answers.iter_mut().map(Costs::Search).collect()
            }
            Answer::AnyHit(answers) => answers.iter_mut().map(|(_, answer)| Costs::Search(answer)).collect(),
            Answer::GraphHit(answers) => answers.iter_mut().map(Costs::Graph).collect(),
            Answer::CachedGraphHit(answers) => {
                answers.iter_mut().map(|answer| Costs::Graph(&mut answer.found)).collect()
            }
            Answer::GridSearch(answers)
            | Answer::OctreeByCells(answers)
            | Answer::OctreeByNeighbours(answers)
            | Answer::OctreeSearch(answers)
            | Answer::KdSearch(answers)
            | Answer::BspSearch(answers)
            | Answer::PolygonBspSearch(answers)
            | Answer::CachedSearch(answers) => answers.iter_mut().map(Costs::Cells).collect(),
            Answer::PacketSearch(answers) => answers.iter_mut().map(Costs::Packet).collect(),
            Answer::WideClosestHit(answers) | Answer::WideAnyHit(answers) => {
                answers.iter_mut().map(Costs::Wide).collect()
            }
            Answer::Shade(answers) => answers.iter_mut().map(Costs::Shade).collect(),
            _ => Vec::new(),
        }
    }
}
