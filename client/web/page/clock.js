// A worker that triggers an update every 100 ms: a session needs pings, and browsers slow down the timers of background
// pages, but not those of workers.
setInterval(() => postMessage(0), 100);
