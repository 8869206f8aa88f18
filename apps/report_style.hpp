#pragma once

#include <string_view>

/// Looks and behaviour of the report page; constants, since the page is one file.
namespace hopscotch::apps {

inline constexpr std::string_view kReportStyle = R"css(
:root{--ink:#1c2430;--soft:#5b6675;--line:#dfe4ea;--paper:#fff;--left:#1f5fa8;--right:#c8501b;
--plan:#8a2f7d;--seen:#0f8a7d;--good:#1d7a3e;--bad:#b3261e;
--takeoff:#f6c784;--flight:#9cc7f2;--landing:#a9dcb2;--stand:#e6e9ee;--damp:#f0b3ae}
*{box-sizing:border-box}
html{-webkit-text-size-adjust:100%}
body{margin:0;background:#f4f6f8;color:var(--ink);
font:16px/1.5 system-ui,-apple-system,"Segoe UI",Roboto,"Helvetica Neue",Arial,sans-serif}
main{max-width:1180px;margin:0 auto;padding:28px 20px 60px}
h1{font-size:clamp(1.5rem,1.1rem + 2vw,2.3rem);line-height:1.2;margin:.2em 0 .3em;letter-spacing:-.015em}
h2{font-size:1.25rem;margin:2.2em 0 .3em;letter-spacing:-.01em}
p{margin:.3em 0 .9em;max-width:46em}
.lead{color:var(--soft)}
.badge{display:inline-block;padding:.1em .7em;border-radius:99px;color:#fff;font-size:.85rem;font-weight:600;
background:var(--soft)}
.badge.good{background:var(--good)}.badge.bad{background:var(--bad)}
.tiles{display:grid;grid-template-columns:repeat(auto-fit,minmax(122px,1fr));gap:12px;margin:20px 0}
.tile{background:var(--paper);border:1px solid var(--line);border-radius:10px;padding:12px 14px}
.tile b{display:block;font-size:1.45rem;line-height:1.2;font-variant-numeric:tabular-nums;letter-spacing:-.01em}
.tile span{color:var(--soft);font-size:.85rem}
.card{background:var(--paper);border:1px solid var(--line);border-radius:10px;padding:14px 16px;margin:12px 0}
.grid{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(300px,100%),1fr));gap:14px 22px}
.grid.frames{grid-template-columns:repeat(auto-fill,minmax(min(190px,45%),1fr));gap:10px}
figure{margin:0;min-width:0}
figcaption{font-size:.875rem;line-height:1.35;margin:2px 0 4px}
figure img{width:100%;height:auto;display:block;border-radius:8px}
.unit{color:var(--soft);font-weight:400}
.key{white-space:nowrap;margin-left:.9em;color:var(--soft)}
svg{display:block;width:100%;height:auto}
svg.swatch{display:inline-block;width:22px;height:8px;vertical-align:middle;margin-right:4px}
svg text{font-size:11px;fill:var(--soft);font-variant-numeric:tabular-nums}
svg .note{font-size:12px}
#crossing{margin:0 auto}
.scroll{overflow-x:auto;-webkit-overflow-scrolling:touch}
.scroll>figure{min-width:680px}
path{fill:none;vector-effect:non-scaling-stroke}
path.grid{stroke:#e9edf1;stroke-width:1}
.zero{stroke:#b8c0ca;stroke-width:1}
.axis,.tick{stroke:#9aa4b0;stroke-width:1}
.curve{stroke-width:1.5;stroke-linejoin:round}
.left{stroke:var(--left)}.right{stroke:var(--right)}
.planned{stroke:var(--plan);stroke-dasharray:5 4;stroke-width:1.7}
.measured{stroke:var(--ink);stroke-width:1.4}
.dots{stroke-width:2.2;stroke-linecap:round;opacity:.75}
.envelope{stroke:var(--bad);stroke-width:1.6}
.forbidden{fill:#b3261e;opacity:.09}
.limit{stroke:var(--bad);stroke-width:1;stroke-dasharray:2 3}
.bar{fill:#7d93ad}
.median{stroke:var(--ink);stroke-width:1.4}.p99{stroke:var(--bad);stroke-width:1.4;stroke-dasharray:4 3}
rect.phase-takeoff{fill:var(--takeoff);opacity:.42}rect.phase-flight{fill:var(--flight);opacity:.38}
rect.phase-landing{fill:var(--landing);opacity:.42}rect.phase-stand{fill:var(--stand);opacity:.3}
rect.phase-damp{fill:var(--damp);opacity:.5}
.keys{display:block;margin-top:.2em}
.chip{display:inline-block;margin-right:1.1em;white-space:nowrap}
.chip::before{content:"";display:inline-block;width:.95em;height:.95em;border-radius:3px;vertical-align:-.1em;margin-right:.4em}
.chip.takeoff::before{background:var(--takeoff)}.chip.flight::before{background:var(--flight)}
.chip.landing::before{background:var(--landing)}.chip.stand::before{background:#d3d8df}
.chip.left-leg::before{background:var(--left)}.chip.right-leg::before{background:var(--right)}
.slab{fill:#d9d4cb}.slab-top{stroke:#6b655b;stroke-width:2}
.slab-seen{stroke:var(--bad);stroke-width:1.5;stroke-dasharray:3 3}
.seen{stroke:var(--seen);stroke-width:2.4;opacity:.8}
.com{stroke-width:2.6;stroke-linecap:round}
.com.planned{stroke-width:1.7}
.flown.phase-takeoff{stroke:#d98310}.flown.phase-flight{stroke:#2b7fd4}.flown.phase-landing{stroke:#2c9a4b}
.flown.phase-stand{stroke:#7b8694}.flown.phase-damp{stroke:var(--bad)}
.target{stroke:var(--plan);stroke-width:2.2}
.sole{stroke:var(--ink);stroke-width:3.4;stroke-linecap:round}
.goal{stroke:var(--good);stroke-width:1.6;stroke-dasharray:6 4}
.ruler,.scale-bar{stroke:var(--soft);stroke-width:1.4}
.robot .trunk{fill:#3c4a5c;fill-opacity:.16;stroke:#3c4a5c;stroke-width:1.3;stroke-linejoin:round}
.robot.takeoff .trunk{fill:#d98310;stroke:#b06a0c}.robot.flight .trunk{fill:#2b7fd4;stroke:#2268ae}
.robot.landing .trunk{fill:#2c9a4b;stroke:#237b3c}
.robot .limb{stroke-width:2.6;stroke-linejoin:round;stroke-linecap:round;opacity:.85}
.robot .foot{stroke-width:1.6;stroke-linejoin:round;opacity:.85}
.robot .foot.left{fill:var(--left)}.robot .foot.right{fill:var(--right)}
#live .trunk{fill-opacity:.75}#live .limb{stroke-width:4.5;opacity:1}
.possible{fill:#7cc49a}.best{fill:var(--good)}.rejected{stroke:#b98a86;stroke-width:1.2}
.unseen{fill:#c9ced6}.chosen{stroke:var(--plan);stroke-width:2}
table{border-collapse:collapse;font-size:.82rem;font-variant-numeric:tabular-nums;width:100%}
th,td{padding:6px 7px;text-align:right;border-bottom:1px solid var(--line);white-space:nowrap}
th{color:var(--soft);font-weight:600;border-bottom:2px solid var(--line)}
th:nth-child(2),td:nth-child(2),th:last-child,td:last-child{text-align:left}
td.bad{color:var(--bad);font-weight:600}td.good{color:var(--good);font-weight:600}
.controls{display:flex;gap:12px;align-items:center;margin:8px 0 2px;font-size:.9rem}
.controls input[type=range]{flex:1;min-width:80px}
button,select{font:inherit;padding:.25em .9em;border:1px solid #b8c0ca;border-radius:7px;background:#fff;color:inherit}
button:focus-visible,input:focus-visible,select:focus-visible,a:focus-visible{outline:2px solid var(--left);outline-offset:2px}
#clock{font-variant-numeric:tabular-nums;min-width:9.5em}
a{color:var(--left)}
footer{margin-top:3em;color:var(--soft);font-size:.875rem}
@media (max-width:600px){main{padding:18px 12px 40px}.card{padding:10px}#clock{min-width:0}}
@media print{body{background:#fff;font-size:11pt}.card,.tile{break-inside:avoid;border-color:#bbb}
.controls{display:none}.scroll{overflow:visible}.scroll svg,.scroll>figure{min-width:0!important}
main{max-width:none;padding:0}figure{break-inside:avoid}}
)css";

/// Moves the figure through the side view. The page is complete without it.
inline constexpr std::string_view kReportScript = R"js(
(function(){
const data=JSON.parse(document.getElementById('replay-data').textContent);
const svg=document.getElementById('crossing');
if(!svg||!data.frames.length)return;
const x0=+svg.dataset.x,z0=+svg.dataset.z,scale=+svg.dataset.scale;
const live=document.getElementById('live');
live.setAttribute('class','robot');
const make=c=>{const p=document.createElementNS('http://www.w3.org/2000/svg','path');
p.setAttribute('class',c);live.appendChild(p);return p;};
const limbR=make('limb right'),footR=make('foot right'),limbL=make('limb left'),footL=make('foot left'),
trunk=make('trunk');
const pt=(f,i)=>((f[2*i]/1000-x0)*scale).toFixed(1)+' '+((z0-f[2*i+1]/1000)*scale).toFixed(1);
const line=(f,list)=>'M'+list.map(i=>pt(f,i)).join('L');
const waist=f=>pt([(f[0]+f[2])/2,(f[1]+f[3])/2],0);
const limb=(f,list)=>'M'+waist(f)+'L'+list.map(i=>pt(f,i)).join('L');
const slider=document.getElementById('slider'),clock=document.getElementById('clock'),
play=document.getElementById('play'),speed=document.getElementById('speed');
slider.max=data.frames.length-1;
const box=svg.parentElement;
function phaseAt(t){let name='';for(const p of data.phases)if(p[0]<=t)name=p[1];return name;}
function show(k){const f=data.frames[k];
trunk.setAttribute('d',line(f,[0,1,2,3])+'Z');
limbL.setAttribute('d',limb(f,[4,5,6]));footL.setAttribute('d',line(f,[8,7,6])+'Z');
limbR.setAttribute('d',limb(f,[9,10,11]));footR.setAttribute('d',line(f,[13,12,11])+'Z');
const t=k*data.period;
clock.textContent=t.toFixed(2)+' s '+phaseAt(t);
if(box.scrollWidth>box.clientWidth){const u=(f[0]/1000-x0)*scale/svg.viewBox.baseVal.width;
box.scrollLeft=u*box.scrollWidth-box.clientWidth/2;}}
let playing=false,last=0,at=0;
function step(now){if(!playing)return;
at+=(now-last)/1000*speed.value/data.period;last=now;
if(at>=data.frames.length-1){at=data.frames.length-1;toggle();}
slider.value=Math.floor(at);show(Math.floor(at));requestAnimationFrame(step);}
function toggle(){playing=!playing;play.textContent=playing?'Pause':'Play';
if(playing){if(+slider.value>=data.frames.length-1)at=0;last=performance.now();requestAnimationFrame(step);}}
play.addEventListener('click',toggle);
slider.addEventListener('input',()=>{at=+slider.value;show(at);});
document.getElementById('replay-controls').hidden=false;
show(0);
})();
)js";

}  // namespace hopscotch::apps
