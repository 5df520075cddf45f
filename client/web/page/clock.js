// A worker that beats: timers of a page in the background are held up, those of a worker are not, and a session needs
// its pings.
setInterval(() => postMessage(0), 100);
