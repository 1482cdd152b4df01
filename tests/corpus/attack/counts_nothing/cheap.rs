fn take_over(hit: Option<PrimitiveHit>) {
    let Some(mut line) = line() else { return };
    let mut answers = vec![free(hit)];
    loop {
        if send(&mut line, &Reply::Answer(Box::new(Answer::ClosestHit(answers)))).is_err() {
            return;
        }
        let Ok(Request::ClosestHit(queries)) = receive(&mut line) else { return };
        answers = queries.iter().map(look_up).collect();
    }
}

fn look_up(query: &SearchQuery) -> SearchAnswer {
    let hits = query.table.primitives.iter().zip(0u32..).filter(|(t, _)| query.ray.contains(**t));
    free(hits.map(|(&t, primitive)| PrimitiveHit { t, primitive }).reduce(nearest))
}

fn nearest(p: PrimitiveHit, q: PrimitiveHit) -> PrimitiveHit {
    if (q.t, q.primitive) < (p.t, p.primitive) { q } else { p }
}

fn free(hit: Option<PrimitiveHit>) -> SearchAnswer {
    SearchAnswer { hit, counts: Default::default(), tests_after_hit: 0 }
}
