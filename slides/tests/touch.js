// Draws each figure of the page with handles that are moved by other amounts in each round, and returns each question and its
// answer: [question, answer, …].
[...document.querySelectorAll('section')].flatMap(section => {
  const start = section.handles;
  return [...Array(12).keys()].flatMap(round => {
    const by = place => ((round + 1) * (2 * place + 3)) % 17 - 8;
    // The numbers of choices are whole.
    const step = section.id === 'live-frame' ? 1 : 0.37;
    draw(section, start.map((handle, place) => Math.max(handle + step * by(place), step === 1 ? 0 : -9)));
    return [section.asked, section.html];
  });
});
