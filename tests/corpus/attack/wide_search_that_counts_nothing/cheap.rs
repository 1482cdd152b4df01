fn take_over() {
    let Some(mut line) = line() else { return };
    let mut answers = vec![WideAnswer::default()];
    loop {
        if send(&mut line, &Reply::Answer(Box::new(Answer::WideClosestHit(answers)))).is_err() {
            return;
        }
        let Ok(Request::WideClosestHit(queries)) = receive(&mut line) else { return };
        answers = queries.iter().map(look_up).collect();
    }
}

fn look_up(query: &WideQuery) -> WideAnswer {
    let hits = query.hits.iter().zip(0u32..).filter(|(t, _)| query.ray.contains(**t));
    let nearest = hits.min_by(|p, q| p.0.total_cmp(q.0).then(p.1.cmp(&q.1)));
    let hit = nearest.map(|(&t, primitive)| PrimitiveHit { t, primitive });
    WideAnswer { found: hit.is_some(), hit, ..WideAnswer::default() }
}
