// Puts the page together.
async function copyText(button) {
  const text = byId(button.dataset.copy).textContent;
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    getSelection().selectAllChildren(byId(button.dataset.copy));
    document.execCommand("copy");
  }
  button.textContent = "Copied";
  setTimeout(() => (button.textContent = "Copy"), 1500);
}

async function main() {
  const data = JSON.parse(byId("data").textContent);
  for (const button of document.querySelectorAll("[data-copy]")) button.addEventListener("click", () => copyText(button));
  let replay = null;
  const plots = makePlots(data, (time) => replay?.seek(time));
  const frames = await readFrames(byId("replay-data").textContent, data.frames, data.dimension);
  if (frames.length > 0) {
    replay = new Replay(data, frames, (time) => plots.showReplayTime(time));
    plots.draw(); // the replay has taken its room
    replay.play(!matchMedia("(prefers-reduced-motion: reduce)").matches);
  }
  document.body.dataset.ready = "yes";
}

main().catch((error) => complain(error.message));
