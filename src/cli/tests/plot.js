// Finds what cannot be read in the plot of the page, drawn 560 units high, as below the title of a slide of 1280 by 720: small
// text, text that touches other text or leaves the drawing, and axes that use little of the width. `cost.rs` evaluates this file
// in a browser.
(() => {
  const svg = document.querySelector('svg')
  svg.style.height = '560px'
  const frame = svg.getBoundingClientRect()
  const found = []
  const texts = [...svg.querySelectorAll('text')].map(text => ({ words: text.textContent, box: text.getBoundingClientRect() }))
  const scale = frame.height / svg.viewBox.baseVal.height
  for (const text of svg.querySelectorAll('text')) {
    // A fortieth of the slide's height.
    const size = scale * parseFloat(text.getAttribute('font-size'))
    if (size < 18) found.push(`${text.textContent}: ${size.toFixed(1)} units high`)
  }
  texts.forEach(({ words, box }, index) => {
    if (box.left < frame.left || box.right > frame.right || box.bottom > frame.bottom) found.push(`${words}: outside`)
    for (const other of texts.slice(index + 1)) {
      // A box has a fifth of its height as empty space above and below its letters.
      const [high, wide] = [Math.min(box.bottom, other.box.bottom) - Math.max(box.top, other.box.top), Math.min(box.right, other.box.right) - Math.max(box.left, other.box.left)]
      if (high > 0.2 * box.height && wide > 0) found.push(`${words} touches ${other.words}`)
    }
  })
  // The longest horizontal line of the grid.
  const lines = [...svg.querySelectorAll('polyline')].map(line => line.points).filter(points => points.length === 2 && points[0].y === points[1].y)
  const share = Math.max(0, ...lines.map(points => points[1].x - points[0].x)) / svg.viewBox.baseVal.width
  if (share <= 0.8) found.push(`the axes use ${Math.round(100 * share)} % of the width`)
  return found
})()
