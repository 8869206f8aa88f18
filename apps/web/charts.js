// The strip behind the time slider: phases, jumps and the tightest limit.

export const kPhaseColors = {
  stand: '#b9c4c9', crouch: '#efc27e', takeoff: '#e39a2d', flight: '#2f7fb8', landing: '#4f9d69',
  recover: '#8bbf9d', hold: '#7d8b92', damp: '#c0392b', fault: '#c0392b',
};

export function drawStrip(canvas, feed) {
  const width = canvas.clientWidth;
  if (canvas.width !== width) canvas.width = width;
  const context = canvas.getContext('2d');
  context.clearRect(0, 0, width, canvas.height);
  const span = feed.end - feed.begin;
  if (span <= 0) return;
  const phase = feed.column.phase;
  const shares = ['torque', 'speed', 'power'].map((name) => feed.column[name]);
  const tight = new Array(width).fill(0);
  feed.frames.forEach((frame) => {
    const x = Math.min(width - 1, Math.floor(((frame[0] - feed.begin) / span) * width));
    context.fillStyle = kPhaseColors[frame[phase]] ?? '#000';
    context.fillRect(x, 0, Math.max(1.5, width / feed.frames.length + 0.5), canvas.height);
    tight[x] = Math.max(tight[x], ...shares.map((column) => frame[column] ?? 0));
  });
  context.fillStyle = '#17252b66';
  tight.forEach((share, x) => {
    const height = Math.min(1, share) * canvas.height * 0.8;
    context.fillRect(x, canvas.height - height, 1, height);
  });
}
