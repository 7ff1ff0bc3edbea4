// react.jsx: a scene and sliders for its parameters in React.
import { useEffect, useRef, useState } from 'react';
import { createRoot } from 'react-dom/client';
import { locate } from 'krs';

locate('krs/'); // where workers and the compiler are

const text = `param radius = 1 in [0.5, 1.5];
param turn = 0.5 in [0, 3];
show box([1, 1, 1]).rotate([0, 1, 0], turn) | sphere(0.6 * radius).move([0, 0.6, 0]);`;

function Shape() {
    const view = useRef(null), [parameters, setParameters] = useState([]);
    useEffect(() => {
        view.current.update(text, { name: 'shape.krs' }).then(() => setParameters([...view.current.scene.parameters]));
    }, []);
    const set = async (name, value) => {
        await view.current.scene.set(name, Number(value));
        setParameters(view.current.scene.parameters.map(p => ({ ...p })));
    };
    return <>
        <krs-view ref={view} controls="" style={{ width: '640px', height: '360px' }} />
        {parameters.map(({ name, low, high, value }) => <label key={name}>{name}
            <input type="range" min={low[0]} max={high[0]} step="any" value={value[0]} onChange={event => set(name, event.target.value)} />
        </label>)}
    </>;
}
createRoot(document.body.appendChild(document.createElement('div'))).render(<Shape />);
