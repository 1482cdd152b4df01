// Finds slides whose content does not fit: an element ends below the padding, or code or a table is too wide.
//
//     node slides/overflow.mjs DECK.md …
//
// It prints a line per slide that overflows, and exits with 1 if there is one. Marp, of `slides/package.json`, makes the pages.
// They are measured in Chromium, Chrome or Edge, whose path is in CHROME_PATH or which is found by its usual names, through
// the package puppeteer-core that Marp brings along.

import { execFileSync } from 'node:child_process'
import { existsSync, mkdtempSync, rmSync, symlinkSync } from 'node:fs'
import { createRequire } from 'node:module'
import { tmpdir } from 'node:os'
import { basename, delimiter, dirname, join, resolve } from 'node:path'
import { fileURLToPath, pathToFileURL } from 'node:url'

const slides = dirname(fileURLToPath(import.meta.url))
const marp = join(slides, 'node_modules', '@marp-team', 'marp-cli')
const puppeteer = createRequire(join(marp, 'package.json'))('puppeteer-core')

/** The path of a browser; undefined if there is none. */
function browserPath() {
  if (process.env.CHROME_PATH) return process.env.CHROME_PATH
  const names = ['chromium', 'chromium-browser', 'google-chrome', 'google-chrome-stable', 'microsoft-edge']
  const folders = (process.env.PATH ?? '').split(delimiter)
  return folders.flatMap(folder => names.map(name => join(folder, name))).find(existsSync)
}

/** Measures the slides of the page; it runs in the browser. A slide is 1280 by 720 units. */
function overflowing() {
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
}

const executablePath = browserPath()
if (!executablePath) {
  console.error('no browser was found; set CHROME_PATH')
  process.exit(2)
}
const folder = mkdtempSync(join(tmpdir(), 'raykata-slides-'))
symlinkSync(join(slides, 'figures'), join(folder, 'figures'))
const browser = await puppeteer.launch({ executablePath, timeout: 0, args: ['--no-sandbox', '--disable-gpu'] })
let failed = false
try {
  const page = await browser.newPage()
  await page.setViewport({ width: 1280, height: 720 })
  for (const deck of process.argv.slice(2)) {
    const html = join(folder, `${basename(deck, '.md')}.html`)
    const theme = ['--theme-set', join(slides, 'raykata.css')]
    const options = ['--no-stdin', '--template', 'bare', ...theme, '--html', resolve(deck), '-o', html]
    execFileSync(process.execPath, [join(marp, 'marp-cli.js'), ...options], { stdio: ['ignore', 'ignore', 'pipe'] })
    await page.goto(pathToFileURL(html).href, { waitUntil: 'load', timeout: 0 })
    for (const line of await page.evaluate(overflowing)) {
      console.log(`${basename(deck)}, ${line}`)
      failed = true
    }
  }
} finally {
  await browser.close()
  rmSync(folder, { recursive: true })
}
process.exit(failed ? 1 : 0)
