// Finds slides of the page whose content does not fit: an element ends below the padding, or code or a table is too wide. A slide
// is 1280 by 720 units. Also finds slides whose figures and code do not follow the colours of the system. `overflow.rs` evaluates this
// file in a browser.
(() => {
  const found = []
  document.querySelectorAll('section').forEach((section, index) => {
    const frame = section.getBoundingClientRect()
    const scale = 1280 / frame.width
    const style = getComputedStyle(section)
    const lowest = 720 - parseFloat(style.paddingBottom)
    const rightmost = 1280 - parseFloat(style.paddingRight)
    const problems = []
    // Headers and footers have a place of their own.
    const parts = [...section.children].filter(part => !['HEADER', 'FOOTER'].includes(part.tagName))
    const bottom = Math.max(0, ...parts.map(part => scale * (part.getBoundingClientRect().bottom - frame.top)))
    if (style.colorScheme !== 'light dark') problems.push(`has the colour scheme ${style.colorScheme}`)
    if (bottom > lowest + 1) problems.push(`ends at ${Math.round(bottom)} of ${lowest}`)
    for (const part of section.querySelectorAll('pre, table, mjx-container, img')) {
      const right = scale * (part.getBoundingClientRect().right - frame.left)
      const hidden = part.scrollWidth - part.clientWidth
      if (right > rightmost + 1) problems.push(`${part.tagName} ends at ${Math.round(right)} of ${rightmost}`)
      if (part.tagName === 'PRE' && hidden > 1) problems.push(`PRE is ${hidden} too wide`)
    }
    const heading = section.querySelector('h1, h2')?.textContent ?? ''
    if (problems.length > 0) found.push(`slide ${index + 1} (${heading}): ${problems.join(', ')}`)
  })
  return found
})()
